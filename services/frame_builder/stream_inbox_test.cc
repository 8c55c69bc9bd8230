#include "services/frame_builder/stream_inbox.h"

#include <gtest/gtest.h>

#include "common/bus/memory_bus.h"

namespace evit {
namespace {

using Verdict = StreamInbox::Verdict;

EventPacket Events(std::int64_t epoch, std::int64_t seq) {
  EventPacket m;
  m.epoch = epoch;
  m.seq = seq;
  return m;
}

imu_batch_t Imu(std::int64_t epoch, std::int64_t seq) {
  imu_batch_t m{};
  m.epoch = epoch;
  m.seq = seq;
  return m;
}

stream_end_t End(std::int64_t epoch, std::int64_t events, std::int64_t imu) {
  stream_end_t m{};
  m.epoch = epoch;
  m.n_events_messages = events;
  m.n_imu_messages = imu;
  return m;
}

class StreamInboxTest : public ::testing::Test {
 protected:
  std::unique_ptr<Bus> bus_ = OpenMemoryBus(MakeMemoryHub());
  StatusReporter status_{bus_.get(), Channels(), "frame_builder", 1};
  StreamInbox lossless_{&status_, true}, live_{&status_, false};
};

// Another replay with its own log: what it sends is refused, and said.
TEST_F(StreamInboxTest, LosslessRefusesAStreamThatIsOver) {
  EXPECT_EQ(lossless_.Put(Events(7, 0), 10), Verdict::kNewStream);
  EXPECT_EQ(lossless_.Put(Events(8, 0), 10), Verdict::kNewStream);
  EXPECT_FALSE(lossless_.two_senders());
  for (int k = 0; k < 3; ++k) EXPECT_EQ(lossless_.Put(Events(7, 0), 10), Verdict::kRefused);
  EXPECT_TRUE(lossless_.two_senders());
  EXPECT_EQ(lossless_.Put(Events(8, 1), 10), Verdict::kTaken);
}

TEST_F(StreamInboxTest, LosslessTakesExactlyTheNext) {
  EXPECT_EQ(lossless_.Put(Events(7, 1), 10), Verdict::kRefused);  // joins at the beginning only
  EXPECT_EQ(lossless_.Put(Events(7, 0), 10), Verdict::kNewStream);
  EXPECT_EQ(lossless_.Put(Events(7, 2), 10), Verdict::kRefused);
  EXPECT_EQ(lossless_.Put(Events(7, 0), 10), Verdict::kRefused);
  EXPECT_EQ(lossless_.Put(Imu(7, 1), 10), Verdict::kRefused);
  EXPECT_EQ(lossless_.Put(Imu(7, 0), 10), Verdict::kTaken);
  EXPECT_EQ(lossless_.Put(Events(7, 1), 10), Verdict::kTaken);
  EXPECT_EQ(lossless_.taken_events(), 0);
  EXPECT_EQ(lossless_.Take()->bytes, 10u);
  lossless_.Take();
  EXPECT_EQ(lossless_.taken_events(), 1);
  EXPECT_EQ(lossless_.taken_imu(), 1);
  lossless_.End(End(7, 2, 2));
  lossless_.Take();
  EXPECT_FALSE(lossless_.Take());
  EXPECT_FALSE(lossless_.ended());  // one IMU message is still to come
  lossless_.Put(Imu(7, 1), 10);
  EXPECT_FALSE(lossless_.ended());
  lossless_.Take();
  EXPECT_TRUE(lossless_.ended());
  EXPECT_EQ(status_.Counter("EVENTS.lost"), 0);
}

TEST_F(StreamInboxTest, ANewRunOfTheSenderBeginsOnce) {
  lossless_.Put(Events(7, 0), 1);
  lossless_.Put(Imu(7, 0), 1);
  lossless_.Put(Imu(7, 1), 1);
  lossless_.End(End(7, 1, 2));
  EXPECT_EQ(lossless_.Put(Imu(8, 0), 1), Verdict::kNewStream);
  EXPECT_EQ(lossless_.Put(Events(7, 1), 1), Verdict::kRefused);  // straggler of the old run
  EXPECT_EQ(lossless_.Put(Events(8, 0), 1), Verdict::kTaken);
  EXPECT_EQ(lossless_.epoch(), 8);
  EXPECT_TRUE(std::holds_alternative<imu_batch_t>(lossless_.Take()->message));
  EXPECT_TRUE(std::holds_alternative<EventPacket>(lossless_.Take()->message));
  EXPECT_FALSE(lossless_.Take());
  EXPECT_FALSE(lossless_.ended());  // the end was the old run's
}

TEST_F(StreamInboxTest, RealTimeTakesWhatComesAndCountsWhatDoesNot) {
  EXPECT_EQ(live_.Put(Events(7, 5), 1), Verdict::kNewStream);
  EXPECT_EQ(live_.Put(Imu(70, 3), 1), Verdict::kTaken);  // sensors with an epoch each
  EXPECT_EQ(live_.Put(Events(7, 8), 1), Verdict::kTaken);
  EXPECT_EQ(live_.Put(Events(7, 6), 1), Verdict::kRefused);
  EXPECT_EQ(status_.Counter("EVENTS.lost"), 2);
  while (live_.Take()) {
  }
  live_.End(End(9, 100, 100));  // somebody else's
  EXPECT_FALSE(live_.ended());
  live_.End(End(7, 12, 4));
  live_.End(End(7, 12, 4));
  EXPECT_TRUE(live_.ended());
  EXPECT_EQ(status_.Counter("EVENTS.lost"), 2 + 3);
  EXPECT_EQ(live_.Put(Imu(71, 0), 1), Verdict::kNewStream);
  EXPECT_FALSE(live_.ended());
}

TEST_F(StreamInboxTest, AnEmptyRecordingEndsToo) {
  lossless_.End(End(7, 0, 0));
  EXPECT_TRUE(lossless_.ended());
  lossless_.Put(Events(8, 0), 1);
  lossless_.End(End(9, 0, 0));  // does not cut a running stream short
  lossless_.Take();
  EXPECT_FALSE(lossless_.ended());
}

}  // namespace
}  // namespace evit
