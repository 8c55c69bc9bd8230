#include "common/tracking/event_only_tracker.h"

#include <gtest/gtest.h>

#include "tests/helpers/tracking_bench.h"

namespace evit {
namespace {

using synthetic::Motion;

using MotionModel = WindowOptions::MotionModel;
TrackerOptions EventsAlone(MotionModel model) {
  TrackerOptions options = TestOptions();
  options.event_only = true;
  options.window.motion_model = model;
  return options;
}

constexpr Utime kStep = 3'333;  // us: 300 Hz

// The baseline says TRACKING at once; with a motion model it has to prove its start. Moves *t to the newest
// frame.
TrackerOutput UntilTracking(Bench* bench, Utime* t) {
  TrackerOutput out = bench->Step(*t, bench->room);
  for (const Utime end = *t + 1'000'000; out.mode != TrackerMode::kTracking && *t < end;)
    out = bench->Step(*t += kStep, bench->room);
  EXPECT_EQ(out.mode, TrackerMode::kTracking);
  return out;
}

class EventOnlyTrackerWith : public ::testing::TestWithParam<MotionModel> {};
INSTANTIATE_TEST_SUITE_P(Both, EventOnlyTrackerWith,
                         ::testing::Values(MotionModel::kPreviousPose, MotionModel::kConstantVelocity));

TEST_P(EventOnlyTrackerWith, TracksWithoutTheImuAndSaysWhenItIsLost) {
  const Motion motion;
  Bench bench(EventsAlone(GetParam()), motion.State(1.0).T_map_body);
  bench.bias = {{9, 9, 9}, {99, 99, 99}};  // nothing of it is used
  Utime t = 1'000'000;
  TrackerOutput out = UntilTracking(&bench, &t);
  for (const Utime end = t + 1'000'000; t < end;) {
    out = bench.Step(t += kStep, bench.room);
    ASSERT_EQ(out.mode, TrackerMode::kTracking);
    ASSERT_TRUE(out.has_pose);
    EXPECT_LT((out.nodes.back().state.T_map_body.p - motion.State(ToSeconds(t)).T_map_body.p).norm(), 0.02);
  }
  EXPECT_GT(out.covariance(0, 0), 0);
  const auto other = synthetic::RoomPoints(60, 99);
  for (int k = 0; k < 400; ++k) {
    out = bench.Step(t += kStep, other);
    EXPECT_TRUE(!out.has_pose || out.mode != TrackerMode::kTracking);
  }
  EXPECT_EQ(out.mode, TrackerMode::kLost);
}

// A second in which the lens is covered: the body is elsewhere, and does not move as it did.
TEST_P(EventOnlyTrackerWith, GoesOnAfterAHole) {
  const Motion motion;
  Bench bench(EventsAlone(GetParam()), motion.State(1.0).T_map_body);
  Utime t = 1'000'000;
  UntilTracking(&bench, &t);
  // The stamps say a second, the body has moved for 20 ms.
  bench.clock = 1'000'000;
  UntilTracking(&bench, &(t += 20'000));
  for (const Utime end = t + 30'000; t < end;) {
    const TrackerOutput out = bench.Step(t += kStep, bench.room);
    ASSERT_TRUE(out.has_pose);
    EXPECT_LT((out.nodes.back().state.T_map_body.p - motion.State(ToSeconds(t)).T_map_body.p).norm(), 0.02);
    EXPECT_LT(out.nodes.back().state.velocity.norm(), 3);
  }
}

TEST_P(EventOnlyTrackerWith, ResumesFromACheckpoint) {
  const Motion motion;
  Bench bench(EventsAlone(GetParam()), motion.State(0.0).T_map_body);
  bench.tracker->Start(1'000'000, motion.State(1.0), Matrix15d::Identity());
  TrackerOutput out;
  for (Utime t = 1'010'000; t <= 1'050'000; t += kStep) {
    out = bench.Step(t, bench.room);
    ASSERT_TRUE(out.has_pose);
    EXPECT_LT((out.nodes.back().state.T_map_body.p - motion.State(ToSeconds(t)).T_map_body.p).norm(), 0.02);
  }
}

// As if seen from 10 cm beside.
std::vector<Eigen::Vector3f> Moved(std::vector<Eigen::Vector3f> room) {
  for (Eigen::Vector3f& p : room) p += Eigen::Vector3f(0.1F, 0, 0);
  return room;
}

TEST(EventOnlyTracker, DoesNotFollowAFrameThatFitsWhereNothingCanGetToInTime) {
  const Motion motion;
  Bench bench(EventsAlone(MotionModel::kPreviousPose), motion.State(1.0).T_map_body);
  for (Utime t = 1'000'000; t <= 1'100'000; t += kStep) bench.Step(t, bench.room);
  const Utime jump = 1'103'323;
  const TrackerOutput out = bench.Step(jump, Moved(bench.room));  // 30 m/s
  EXPECT_GT(out.quality.contrast(), 0.3);                         // it fits
  EXPECT_FALSE(out.has_pose);
  EXPECT_EQ(out.mode, TrackerMode::kTracking);
  const TrackerOutput next = bench.Step(jump + kStep, bench.room);
  ASSERT_TRUE(next.has_pose);
  EXPECT_LT((next.nodes.back().state.T_map_body.p - bench.Truth(jump + kStep).p).norm(), 0.02);
}

TEST(EventOnlyTracker, ABodyThatMovesOnHoldsItsPoseAgainstOneSuchFrame) {
  const Motion motion;
  Bench bench(EventsAlone(MotionModel::kConstantVelocity), motion.State(1.0).T_map_body);
  Utime t = 1'000'000;
  UntilTracking(&bench, &t);
  TrackerOutput out;
  for (int k = 0; k < 30; ++k) out = bench.Step(t += kStep, bench.room);
  const BodyState truth = motion.State(ToSeconds(t));
  EXPECT_LT((out.nodes.back().state.velocity - truth.velocity).norm(), 0.3 * truth.velocity.norm());
  const Utime jump = t + kStep;
  out = bench.Step(jump, Moved(bench.room));
  if (out.has_pose) {
    EXPECT_LT((out.nodes.back().state.T_map_body.p - bench.Truth(jump).p).norm(), 0.03);
  }
  out = bench.Step(jump + kStep, bench.room);
  ASSERT_TRUE(out.has_pose);
  EXPECT_LT((out.nodes.back().state.T_map_body.p - bench.Truth(jump + kStep).p).norm(), 0.02);
}

TEST_P(EventOnlyTrackerWith, GoesOnWhereTheClockGoesBack) {
  const Motion motion;
  Bench bench(EventsAlone(GetParam()), motion.State(1.0).T_map_body);
  Utime t = 1'000'000;
  UntilTracking(&bench, &t);
  bench.clock = -500'000;
  UntilTracking(&bench, &(t += kStep));
  EXPECT_TRUE(bench.Step(t += kStep, bench.room).has_pose);
}

TEST(EventOnlyTracker, ProvesAWrongStartPoseBeforeItSaysTracking) {
  const Motion motion;
  SE3 start = motion.State(1.0).T_map_body;
  start.p += Eigen::Vector3d(0.03, -0.03, 0.02);
  start.q = start.q * ExpSO3(Eigen::Vector3d(0.02, 0.04, -0.02));
  Bench bench(EventsAlone(MotionModel::kConstantVelocity), start);
  Utime t = 1'000'000, tracks_since = 0;
  EXPECT_FALSE(bench.Step(t, bench.room).has_pose);
  EXPECT_EQ(bench.tracker->mode(), TrackerMode::kBootstrapping);
  for (const Utime end = t + 500'000; t < end;) {
    const TrackerOutput out = bench.Step(t += kStep, bench.room);
    if (out.mode == TrackerMode::kTracking && tracks_since == 0) tracks_since = t;
    if (out.has_pose) {
      EXPECT_LT((out.nodes.back().state.T_map_body.p - bench.Truth(t).p).norm(), 0.03) << t;
    }
  }
  EXPECT_GT(tracks_since, 1'100'000);
  EXPECT_LT(tracks_since, 1'400'000);
}

// Someone has moved the camera while the lens was covered.
TEST(EventOnlyTracker, IsNotTrackingInAnotherPlaceBeforeItHasProvedIt) {
  const Motion motion;
  Bench bench(EventsAlone(MotionModel::kConstantVelocity), motion.State(1.0).T_map_body);
  Utime t = 1'000'000;
  UntilTracking(&bench, &t);
  for (int k = 0; k < 40; ++k) EXPECT_FALSE(bench.Step(t += kStep, {}).has_pose);
  EXPECT_NE(bench.tracker->mode(), TrackerMode::kTracking);
  int proved = 0;
  for (int k = 0; k < 300; ++k) {
    const TrackerOutput out = bench.Step(t += kStep, Moved(bench.room));
    if (!out.has_pose) continue;
    const SE3& pose = out.nodes.back().state.T_map_body;
    EXPECT_LT((pose.p + Eigen::Vector3d(0.1, 0, 0) - bench.Truth(t).p).norm(), 0.03) << k;
    proved += out.mode == TrackerMode::kTracking;
    if (k < 30) {
      EXPECT_NE(out.mode, TrackerMode::kTracking);
    }
  }
  EXPECT_GT(proved, 0);
}

}  // namespace
}  // namespace evit
