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

class EventOnlyTrackerWith : public ::testing::TestWithParam<MotionModel> {};
INSTANTIATE_TEST_SUITE_P(Both, EventOnlyTrackerWith,
                         ::testing::Values(MotionModel::kPreviousPose, MotionModel::kConstantVelocity));

TEST_P(EventOnlyTrackerWith, TracksWithoutTheImuAndSaysWhenItIsLost) {
  const Motion motion;
  Bench bench(EventsAlone(GetParam()), motion.State(1.0).T_map_body);
  bench.bias = {{9, 9, 9}, {99, 99, 99}};  // nothing of it is used
  TrackerOutput out;
  for (Utime t = 1'000'000; t <= 2'000'000; t += 3'333) {
    out = bench.Step(t, bench.room);
    ASSERT_EQ(out.mode, TrackerMode::kTracking);
    ASSERT_TRUE(out.has_pose);
    EXPECT_LT((out.nodes.back().state.T_map_body.p - motion.State(ToSeconds(t)).T_map_body.p).norm(), 0.02);
  }
  EXPECT_GT(out.covariance(0, 0), 0);
  const auto other = synthetic::RoomPoints(60, 99);
  Utime t = 2'003'333;
  for (int k = 0; k < 200; ++k, t += 3'333) out = bench.Step(t, other);
  EXPECT_EQ(out.mode, TrackerMode::kLost);
}

// A second in which the lens is covered: the body is elsewhere, and does not move as it did.
TEST_P(EventOnlyTrackerWith, GoesOnAfterAHole) {
  const Motion motion;
  Bench bench(EventsAlone(GetParam()), motion.State(1.0).T_map_body);
  for (Utime t = 1'000'000; t <= 1'100'000; t += 3'333) bench.Step(t, bench.room);
  // The stamps say a second, the body has moved for 20 ms.
  bench.clock = 1'000'000;
  TrackerOutput out;
  for (Utime t = 1'120'000; t <= 1'150'000; t += 3'333) {
    out = bench.Step(t, bench.room);
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
  for (Utime t = 1'010'000; t <= 1'050'000; t += 3'333) {
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
  for (Utime t = 1'000'000; t <= 1'100'000; t += 3'333) bench.Step(t, bench.room);
  const Utime jump = 1'103'323;
  const TrackerOutput out = bench.Step(jump, Moved(bench.room));  // 30 m/s
  EXPECT_GT(out.quality.contrast(), 0.3);                         // it fits
  EXPECT_FALSE(out.has_pose);
  EXPECT_EQ(out.mode, TrackerMode::kTracking);
  const TrackerOutput next = bench.Step(jump + 3'333, bench.room);
  ASSERT_TRUE(next.has_pose);
  EXPECT_LT((next.nodes.back().state.T_map_body.p - bench.Truth(jump + 3'333).p).norm(), 0.02);
}

TEST(EventOnlyTracker, ABodyThatMovesOnHoldsItsPoseAgainstOneSuchFrame) {
  const Motion motion;
  Bench bench(EventsAlone(MotionModel::kConstantVelocity), motion.State(1.0).T_map_body);
  TrackerOutput out;
  for (Utime t = 1'000'000; t <= 1'100'000; t += 3'333) out = bench.Step(t, bench.room);
  const BodyState truth = motion.State(1.1);
  EXPECT_LT((out.nodes.back().state.velocity - truth.velocity).norm(), 0.3 * truth.velocity.norm());
  const Utime jump = 1'103'323;
  out = bench.Step(jump, Moved(bench.room));
  if (out.has_pose) {
    EXPECT_LT((out.nodes.back().state.T_map_body.p - bench.Truth(jump).p).norm(), 0.03);
  }
  out = bench.Step(jump + 3'333, bench.room);
  ASSERT_TRUE(out.has_pose);
  EXPECT_LT((out.nodes.back().state.T_map_body.p - bench.Truth(jump + 3'333).p).norm(), 0.02);
}

TEST_P(EventOnlyTrackerWith, GoesOnWhereTheClockGoesBack) {
  const Motion motion;
  Bench bench(EventsAlone(GetParam()), motion.State(1.0).T_map_body);
  for (Utime t = 1'000'000; t <= 1'050'000; t += 3'333) bench.Step(t, bench.room);
  bench.clock = -500'000;
  TrackerOutput out;
  for (Utime t = 1'053'000; t <= 1'080'000; t += 3'333) out = bench.Step(t, bench.room);
  EXPECT_TRUE(out.has_pose);
  EXPECT_EQ(out.mode, TrackerMode::kTracking);
}

}  // namespace
}  // namespace evit
