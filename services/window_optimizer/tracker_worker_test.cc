#include "services/window_optimizer/tracker_worker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "common/tracking/tracker.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

using Threading = TrackerWorker::Threading;
using Wait = TrackerWorker::Wait;

class TrackerWorkerTest : public ::testing::TestWithParam<Threading> {
 protected:
  static std::unique_ptr<Tracker> MakeTracker() {
    Rig rig;
    rig.camera = synthetic::VgaCamera();
    rig.T_body_camera = synthetic::BodyCamera();
    return std::make_unique<Tracker>(rig, TrackerOptions(), SE3());
  }
  // A frame without events.
  static KeyframeInput Input(Utime t) {
    KeyframeInput input;
    input.t = t;
    input.surface = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
    return input;
  }
  static QueuedKeyframe Keyframe(std::int64_t seq) {
    QueuedKeyframe keyframe;
    keyframe.message.seq = seq;
    return keyframe;
  }
  TrackerWorker worker_{MakeTracker(), GetParam()};
};

TEST_P(TrackerWorkerTest, NobodyReachesTheTrackerUntilItsResultIsTaken) {
  EXPECT_NE(worker_.idle_tracker(), nullptr);
  EXPECT_FALSE(worker_.working());
  worker_.Start(Keyframe(7), Input(1'000'000));
  EXPECT_EQ(worker_.idle_tracker(), nullptr);
  EXPECT_TRUE(worker_.working());
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // done or not
  EXPECT_EQ(worker_.idle_tracker(), nullptr);
  const auto processed = worker_.Finish(Wait::kYes);
  ASSERT_TRUE(processed.has_value());
  EXPECT_EQ(processed->keyframe.message.seq, 7);
  EXPECT_EQ(processed->output.mode, TrackerMode::kBootstrapping);
  EXPECT_GT(processed->solve_ms, 0);
  ASSERT_NE(worker_.idle_tracker(), nullptr);
  EXPECT_EQ(worker_.idle_tracker()->state_time(), 1'000'000);
  EXPECT_FALSE(worker_.working());
}

TEST_P(TrackerWorkerTest, TakesOneKeyframeAfterTheOther) {
  for (int k = 0; k < 5; ++k) {
    worker_.Start(Keyframe(k), Input(1'000'000 + 10'000 * k));
    std::optional<ProcessedKeyframe> processed;
    while (!processed) processed = worker_.Finish(Wait::kNo);
    EXPECT_EQ(processed->keyframe.message.seq, k);
  }
  EXPECT_EQ(worker_.idle_tracker()->state_time(), 1'040'000);
}

TEST_P(TrackerWorkerTest, NothingBegunNothingFinished) {
  EXPECT_FALSE(worker_.Finish(Wait::kNo).has_value());
  EXPECT_FALSE(worker_.Finish(Wait::kYes).has_value());
}

TEST_P(TrackerWorkerTest, EndsWhileItsThreadWorks) {
  TrackerWorker worker(MakeTracker(), GetParam());
  worker.Start(Keyframe(0), Input(1'000'000));
  EXPECT_TRUE(worker.working());
}

INSTANTIATE_TEST_SUITE_P(Threading, TrackerWorkerTest,
                         ::testing::Values(Threading::kOwnThread, Threading::kCallersThread),
                         [](const auto& info) {
                           return info.param == Threading::kOwnThread ? "OwnThread" : "CallersThread";
                         });

}  // namespace
}  // namespace evit
