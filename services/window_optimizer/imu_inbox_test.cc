#include "services/window_optimizer/imu_inbox.h"

#include <gtest/gtest.h>

#include "common/bus/codec.h"
#include "common/bus/memory_bus.h"

namespace evit {
namespace {

class ImuInboxTest : public ::testing::Test {
 protected:
  // Two samples, 5 ms apart.
  std::vector<ImuSample> Receive(Utime t, std::int64_t seq, std::int64_t epoch = 3) {
    imu_batch_t message{};
    message.utime = t;
    message.seq = seq;
    message.epoch = epoch;
    message.n = 2;
    message.sample_utime = {t, t + 5'000};
    message.gyro = {{1, 2, 3}, {1, 2, 3}};
    message.accel = {{4, 5, 6}, {4, 5, 6}};
    std::vector<std::uint8_t> bytes;
    EncodeTo(message, &bytes);
    return inbox_.OnMessage(bytes.data(), bytes.size());
  }

  std::unique_ptr<Bus> bus_ = OpenMemoryBus(MakeMemoryHub());
  StatusReporter status_{bus_.get(), Channels(), "window_optimizer", 1};
  ImuInbox inbox_{&status_};
};

TEST_F(ImuInboxTest, GivesTheSamplesOfAMessageAndKeepsThem) {
  const std::vector<ImuSample> samples = Receive(100'000, 0);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[1].t, 105'000);
  EXPECT_EQ(samples[1].gyro, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(samples[1].accel, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(inbox_.history().Between(100'000, 105'000).size(), 2U);
}

TEST_F(ImuInboxTest, SamplesHeardBeforeAreLeftOut) {
  Receive(100'000, 0);
  const std::vector<ImuSample> samples = Receive(105'000, 1);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ(samples[0].t, 110'000);
}

TEST_F(ImuInboxTest, ARestartedSenderClearsWhatWasKept) {
  Receive(100'000, 0);
  EXPECT_EQ(Receive(50'000, 0, 4).size(), 2U);
  EXPECT_TRUE(inbox_.history().Between(100'000, 105'000).empty());
}

TEST_F(ImuInboxTest, RubbishIsCounted) {
  const std::vector<std::uint8_t> rubbish(100, 0xab);
  EXPECT_TRUE(inbox_.OnMessage(rubbish.data(), rubbish.size()).empty());
  EXPECT_EQ(status_.Counter("IMU.invalid"), 1);
}

}  // namespace
}  // namespace evit
