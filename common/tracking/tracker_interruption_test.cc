// The tracker where something is missing for a while: events, IMU samples, time.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/helpers/tracking_bench.h"

namespace evit {
namespace {

using synthetic::Motion;

TEST(Tracker, CoastsOnTheImuWhileThereAreNoEvents) {
  const Motion motion;
  TrackerOptions options = TestOptions();
  options.failure.max_coast_s = 1.5;
  Bench bench(options, motion.State(1.0).T_map_body);
  Utime t = 1'000'000;
  TrackerOutput out = bench.UntilTracking(&t);
  for (int k = 0; k < 20; ++k) out = bench.Step(t += 25'000, bench.room);
  ASSERT_EQ(out.mode, TrackerMode::kTracking);
  const auto sigma = [&] { return std::sqrt(out.covariance.topLeftCorner<3, 3>().trace()); };
  const double known = sigma();
  double before = known;
  for (int k = 0; k < 5; ++k) {  // 1 s in the dark
    out = bench.Step(t += 200'000, {});
    EXPECT_EQ(out.mode, TrackerMode::kTracking);
    EXPECT_EQ(out.reason, "coasting on the IMU: no events");
    EXPECT_EQ(out.quality.n_points, 0);
    EXPECT_GT(sigma(), before);
    before = sigma();
  }
  EXPECT_GT(before, 3 * known);
  const auto error = [&] {
    return (out.nodes.back().state.T_map_body.p - motion.State(ToSeconds(t)).T_map_body.p).norm();
  };
  EXPECT_LT(error(), 3 * before);
  for (int k = 0; k < 5; ++k) out = bench.Step(t += 25'000, bench.room);
  EXPECT_EQ(out.reason, "tracking");
  EXPECT_LT(error(), 0.006);
  EXPECT_LT(sigma(), 2 * known);
  // Too long in the dark: it says so.
  for (int k = 0; k < 8; ++k) out = bench.Step(t += 200'000, {});
  EXPECT_EQ(out.mode, TrackerMode::kLost);
  EXPECT_EQ(out.reason.substr(0, 13), "no events for");
}

TEST(Tracker, AClockThatJumpsIsReportedAndTrackingResumes) {
  for (const Utime jump : {Utime{-5'000'000}, Utime{3'600'000'000}}) {
    const Motion motion;
    Bench bench(TestOptions(), motion.State(1.0).T_map_body);
    Utime t = 1'000'000;
    TrackerOutput out = bench.UntilTracking(&t);
    ASSERT_EQ(out.mode, TrackerMode::kTracking);
    bench.clock += jump;
    bench.last = 0;  // frame_builder starts again
    out = bench.Step(t += 10'000, bench.room);
    EXPECT_EQ(out.mode, TrackerMode::kBootstrapping);
    for (int k = 0; k < 60 && out.mode != TrackerMode::kTracking; ++k)
      out = bench.Step(t += 10'000, bench.room);
    EXPECT_EQ(out.mode, TrackerMode::kTracking) << jump;
  }
}

TEST(Tracker, ASolveCutShortKeepsTheBestSoFar) {
  const Motion motion;
  Bench bench(TestOptions(), motion.State(1.0).T_map_body);
  Utime t = 1'000'000;
  TrackerOutput out = bench.UntilTracking(&t);
  ASSERT_EQ(out.mode, TrackerMode::kTracking);
  int whole = 0, cut = 0;
  for (int k = 0; k < 20; ++k) whole += bench.Step(t += 25'000, bench.room).iterations;
  bench.tracker->set_solve_budget(1e-9);
  bench.tracker->set_point_share(0.25);
  for (int k = 0; k < 20; ++k) {
    out = bench.Step(t += 25'000, bench.room);
    cut += out.iterations;
    EXPECT_LE(out.quality.n_points, 150);
  }
  EXPECT_LT(cut, whole);
  EXPECT_EQ(out.mode, TrackerMode::kTracking) << out.reason;  // prediction and warm start carry it
  EXPECT_LT((out.nodes.back().state.T_map_body.p - motion.State(ToSeconds(t)).T_map_body.p).norm(), 0.03);
}

TEST(Tracker, ImuGapIsReportedAndTrackingResumes) {
  const Motion motion;
  Bench bench(TestOptions(), motion.State(1.0).T_map_body);
  Utime t = 1'000'000;
  TrackerOutput out = bench.UntilTracking(&t);
  ASSERT_EQ(out.mode, TrackerMode::kTracking);
  KeyframeInput gap;
  gap.t = t += 40'000;
  gap.seq = bench.seq++;
  gap.n_events = 20000;
  gap.surface = synthetic::DrawSurface(bench.settings, bench.room, motion.State(ToSeconds(t)).T_map_body);
  gap.imu = motion.Samples(bench.last, t, bench.bias);
  gap.imu_gap = 300'000;
  bench.last = t;
  out = bench.tracker->Process(gap);
  EXPECT_EQ(out.mode, TrackerMode::kBootstrapping);
  for (int k = 0; k < 60; ++k) out = bench.Step(t += 10'000, bench.room);
  EXPECT_EQ(out.mode, TrackerMode::kTracking) << out.reason;
}

}  // namespace
}  // namespace evit
