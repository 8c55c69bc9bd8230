#include "services/window_optimizer/keyframe_queue.h"

#include <gtest/gtest.h>

#include "common/bus/channels.h"
#include "common/bus/memory_bus.h"

namespace evit {
namespace {

using Admission = KeyframeQueue::Admission;

constexpr KeyframeQueue::Options kLossless{true};
constexpr KeyframeQueue::Options kRealTime{false, 4, 8, true};

class KeyframeQueueTest : public ::testing::Test {
 protected:
  // Keyframes of 10 ms with three IMU samples each.
  static keyframe_t Keyframe(std::int64_t seq, std::int64_t epoch = 3, bool high_rate = false) {
    keyframe_t k{};
    k.seq = seq;
    k.epoch = epoch;
    k.utime = 10'000 * (seq + 1);
    k.previous_utime = 10'000 * seq;
    k.high_rate = high_rate ? 1 : 0;
    k.imu_utime = {k.previous_utime, k.previous_utime + 5'000, k.utime};
    k.gyro.assign(3, {0, 0, 0});
    k.accel.assign(3, {0, 0, 0});
    k.n_imu = 3;
    return k;
  }
  Admission Admit(KeyframeQueue* queue, std::int64_t seq, std::int64_t epoch = 3) {
    return queue->Admit(Keyframe(seq, epoch), now_);
  }
  static std::vector<std::int64_t> Popped(KeyframeQueue* queue) {
    std::vector<std::int64_t> numbers;
    while (!queue->empty()) numbers.push_back(queue->Pop().message.seq);
    return numbers;
  }
  std::int64_t Counter(const std::string& name) { return status_.Counter("KEYFRAME." + name); }

  std::unique_ptr<Bus> bus_ = OpenMemoryBus(MakeMemoryHub());
  StatusReporter status_{bus_.get(), Channels(), "window_optimizer", 1};
  KeyframeQueue::Clock::time_point now_ = KeyframeQueue::Clock::now();
};

TEST_F(KeyframeQueueTest, LosslessAdmitsTheNextOneOnly) {
  KeyframeQueue queue(&status_, kLossless);
  EXPECT_EQ(Admit(&queue, 0), Admission::kQueued);
  EXPECT_EQ(Admit(&queue, 2), Admission::kOutOfOrder);
  EXPECT_EQ(Admit(&queue, 1), Admission::kQueued);
  EXPECT_EQ(Admit(&queue, 0), Admission::kOld);
  EXPECT_EQ(Admit(&queue, 2), Admission::kQueued);
  EXPECT_EQ(Popped(&queue), (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(Counter("out_of_order"), 1);
  EXPECT_EQ(Counter("lost"), 0);
}

TEST_F(KeyframeQueueTest, LosslessDropsNothing) {
  KeyframeQueue queue(&status_, kLossless);
  for (int k = 0; k < 100; ++k) ASSERT_EQ(Admit(&queue, k), Admission::kQueued);
  EXPECT_EQ(Popped(&queue).size(), 100U);
}

TEST_F(KeyframeQueueTest, LosslessStartsAtZeroWithANewSender) {
  KeyframeQueue queue(&status_, kLossless);
  EXPECT_EQ(Admit(&queue, 1), Admission::kOutOfOrder);
  EXPECT_EQ(Admit(&queue, 0), Admission::kQueued);
  EXPECT_EQ(Admit(&queue, 1, 4), Admission::kOutOfOrder);
  EXPECT_EQ(Admit(&queue, 0, 4), Admission::kQueued);
}

TEST_F(KeyframeQueueTest, LosslessJoinsARunningSenderAtWhatItSendsTwice) {
  KeyframeQueue queue(&status_, kLossless);
  EXPECT_EQ(Admit(&queue, 7), Admission::kOutOfOrder);
  EXPECT_EQ(Admit(&queue, 8), Admission::kOutOfOrder);
  EXPECT_EQ(Admit(&queue, 8), Admission::kQueued);
  EXPECT_EQ(Admit(&queue, 9), Admission::kQueued);
}

TEST_F(KeyframeQueueTest, RealTimeAdmitsWhatIsNewer) {
  KeyframeQueue queue(&status_, kRealTime);
  EXPECT_EQ(Admit(&queue, 5), Admission::kQueued);
  EXPECT_EQ(Admit(&queue, 7), Admission::kQueued);
  EXPECT_EQ(Admit(&queue, 6), Admission::kOld);
  EXPECT_EQ(Popped(&queue), (std::vector<std::int64_t>{5, 7}));
  EXPECT_EQ(Counter("lost"), 1);
}

TEST_F(KeyframeQueueTest, RealTimeDropsTheOldestAndLeavesItsImuToTheNext) {
  KeyframeQueue queue(&status_, kRealTime);
  for (int k = 0; k < 6; ++k) Admit(&queue, k);
  EXPECT_EQ(Counter("dropped"), 2);
  const keyframe_t first = queue.front().message;
  EXPECT_EQ(first.seq, 2);
  EXPECT_EQ(first.previous_utime, 0);
  EXPECT_EQ(first.n_imu, 7);
  EXPECT_EQ(Popped(&queue), (std::vector<std::int64_t>{2, 3, 4, 5}));
}

TEST_F(KeyframeQueueTest, WithoutMergingADroppedKeyframeLeavesNothing) {
  KeyframeQueue queue(&status_, {false, 2, 2, false});
  for (int k = 0; k < 3; ++k) Admit(&queue, k);
  EXPECT_EQ(queue.front().message.seq, 1);
  EXPECT_EQ(queue.front().message.n_imu, 3);
}

TEST_F(KeyframeQueueTest, ABurstOfHighRateFramesHasMoreRoom) {
  KeyframeQueue queue(&status_, kRealTime);
  for (int k = 0; k < 10; ++k) queue.Admit(Keyframe(k, 3, true), now_);
  EXPECT_EQ(Popped(&queue).size(), 8U);
}

TEST_F(KeyframeQueueTest, KeyframesLateByARestartHaveMoreRoom) {
  KeyframeQueue queue(&status_, kRealTime);
  queue.ExpectBurstUpTo(5);
  std::vector<keyframe_t> missed;
  for (int k = 0; k < 6; ++k) missed.push_back(Keyframe(k));
  queue.AdmitCollected(missed, now_);
  EXPECT_EQ(Admit(&queue, 5), Admission::kOld);
  EXPECT_EQ(Admit(&queue, 6), Admission::kQueued);
  EXPECT_TRUE(queue.LateByRestart(Keyframe(6)));
  EXPECT_FALSE(queue.LateByRestart(Keyframe(50)));
  EXPECT_EQ(Popped(&queue).size(), 7U);
  EXPECT_EQ(Counter("dropped"), 0);
}

TEST_F(KeyframeQueueTest, AnotherSendersKeyframesAreNotLateByARestart) {
  KeyframeQueue queue(&status_, kRealTime);
  queue.ExpectBurstUpTo(5);
  Admit(&queue, 0, 4);
  EXPECT_FALSE(queue.LateByRestart(queue.front().message));
}

TEST_F(KeyframeQueueTest, HighRateFramesBeforeANewerOneAreSuperseded) {
  KeyframeQueue queue(&status_, kRealTime);
  for (int k = 0; k < 3; ++k) queue.Admit(Keyframe(k, 3, true), now_);
  queue.DropSuperseded();
  EXPECT_EQ(queue.front().message.previous_utime, 0);
  EXPECT_EQ(Popped(&queue), (std::vector<std::int64_t>{2}));
  EXPECT_EQ(Counter("superseded"), 2);
  EXPECT_EQ(Counter("dropped"), 0);
}

TEST_F(KeyframeQueueTest, OrdinaryKeyframesAreNotSuperseded) {
  KeyframeQueue queue(&status_, kRealTime);
  for (int k = 0; k < 3; ++k) Admit(&queue, k);
  queue.DropSuperseded();
  EXPECT_EQ(Popped(&queue).size(), 3U);
}

}  // namespace
}  // namespace evit
