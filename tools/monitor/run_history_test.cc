#include "tools/monitor/run_history.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/helpers/sample_messages.h"
#include "tools/monitor/page_frames.h"

namespace evit::monitor {
namespace {

constexpr std::size_t kHead = 16, kWindow = 248, kPose = 56;  // bytes, as page/src/frames.ts expects

void AddWindowAt(std::int64_t utime, RunHistory* history) {
  window_state_t window = Sample<window_state_t>();
  window.utime = utime;
  history->AddWindow(window, EncodeWindow(window, -1));
}

std::uint32_t NumberAt(const FramePtr& frame, std::size_t at) {
  std::uint32_t number = 0;
  std::memcpy(&number, frame->data() + at, sizeof number);
  return number;
}

TEST(RunHistory, IsNothingAtFirst) { EXPECT_EQ(RunHistory().Encode(), nullptr); }

TEST(RunHistory, HoldsTenSamplesASecondOfTheLastMinute) {
  RunHistory history;
  for (int i = 0; i < 4500; ++i) AddWindowAt(20'000 * i, &history);  // 90 s at 50 Hz
  body_pose_t truth = Sample<body_pose_t>();
  history.AddTruth(truth, EncodePose(FrameKind::kTruth, truth));
  const FramePtr all = history.Encode();
  EXPECT_EQ(NumberAt(all, 0), static_cast<std::uint32_t>(FrameKind::kHistory));
  EXPECT_EQ(NumberAt(all, 4), 600U);
  EXPECT_EQ(NumberAt(all, 8), 1U);
  ASSERT_EQ(all->size(), kHead + 600 * kWindow + kPose);
  double first = 0, last = 0;
  std::memcpy(&first, all->data() + kHead + 8, sizeof first);
  std::memcpy(&last, all->data() + kHead + 599 * kWindow + 8, sizeof last);
  EXPECT_EQ(last, 89'900'000);
  EXPECT_EQ(last - first, 59'900'000);
}

TEST(RunHistory, ForgetsThePastOfAReplayThatWasRewound) {
  RunHistory history;
  for (int i = 0; i < 100; ++i) AddWindowAt(100'000 * i, &history);
  AddWindowAt(2'000'000, &history);
  EXPECT_EQ(NumberAt(history.Encode(), 4), 1U);
}

}  // namespace
}  // namespace evit::monitor
