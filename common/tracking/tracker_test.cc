#include "common/tracking/tracker.h"

#include <gtest/gtest.h>

#include "common/tracking/pose_covariance.h"
#include "tests/helpers/tracking_bench.h"

namespace evit {
namespace {

using synthetic::Motion;

TEST(Tracker, BootstrapsAndTracksASyntheticRoom) {
  const Motion motion;
  const SE3 start = motion.State(1.0).T_map_body.Plus(
      (Eigen::Matrix<double, 6, 1>() << 0.02, -0.02, 0.01, 0.01, -0.01, 0.01).finished());
  for (const auto first : {WindowOptions::FirstNode::kPrior, WindowOptions::FirstNode::kFixed}) {
    TrackerOptions options = TestOptions();
    options.window.first_node = first;
    // A fixed first node can only be corrected through the slack of the IMU terms.
    if (first == WindowOptions::FirstNode::kFixed) options.window.imu_noise_factor = 50;
    Bench bench(options, start);
    Utime t = 1'000'000;
    TrackerOutput out;
    double worst = 0, worst_angle = 0;
    int tracked = 0;
    for (int k = 0; k < 160; ++k) {
      out = bench.Step(t, bench.room);
      if (out.mode == TrackerMode::kTracking) {
        ++tracked;
        const SE3 truth = motion.State(ToSeconds(t)).T_map_body;
        worst = std::max(worst, (out.nodes.back().state.T_map_body.p - truth.p).norm());
        worst_angle = std::max(worst_angle, AngularDistance(truth.q, out.nodes.back().state.T_map_body.q));
      }
      t += out.mode == TrackerMode::kTracking ? 25'000 : 10'000;
    }
    EXPECT_EQ(out.mode, TrackerMode::kTracking) << out.reason;
    EXPECT_GT(tracked, 80);
    EXPECT_LT(worst, 0.007);
    EXPECT_LT(worst_angle, 0.004);
    EXPECT_GT(out.image_speed, 1);
    EXPECT_GT(out.covariance.diagonal().minCoeff(), 0);
    EXPECT_LT(out.covariance.diagonal().maxCoeff(), 1e-4);
  }
}

TEST(Tracker, SameInputSameOutput) {
  const Motion motion;
  std::vector<SE3> results;
  for (int run = 0; run < 2; ++run) {
    Bench bench(TestOptions(), motion.State(1.0).T_map_body);
    TrackerOutput out;
    for (Utime t = 1'000'000; t < 1'500'000; t += 10'000) out = bench.Step(t, bench.room);
    results.push_back(out.nodes.back().state.T_map_body);
  }
  EXPECT_EQ(results[0].p, results[1].p);
  EXPECT_EQ(results[0].q.coeffs(), results[1].q.coeffs());
}

TEST(Tracker, SaysLostWhenTheWorldIsNotTheMap) {
  const Motion motion;
  Bench bench(TestOptions(), motion.State(1.0).T_map_body);
  Utime t = 1'000'000;
  TrackerOutput out = bench.UntilTracking(&t);
  ASSERT_EQ(out.mode, TrackerMode::kTracking);
  const auto other = synthetic::RoomPoints(60, 99);
  for (int k = 0; k < 40 && out.mode == TrackerMode::kTracking; ++k) out = bench.Step(t += 25'000, other);
  EXPECT_EQ(out.mode, TrackerMode::kLost);
  EXPECT_FALSE(out.has_pose);
  EXPECT_NE(out.reason, "");
}

TEST(Tracker, FindsTheMapAgainWhileTheBodyMoves) {
  const Motion motion{0.4, 0.3};
  TrackerOptions options = TestOptions();
  options.failure.max_coast_s = 0.2;
  Bench bench(options, motion.State(1.0).T_map_body);
  bench.motion = motion;
  Utime t = 1'000'000;
  TrackerOutput out = bench.UntilTracking(&t);
  ASSERT_EQ(out.mode, TrackerMode::kTracking);
  for (int k = 0; k < 20; ++k) out = bench.Step(t += 25'000, bench.room);
  const auto other = synthetic::RoomPoints(60, 99);
  const Eigen::Vector3d before = motion.State(ToSeconds(t)).T_map_body.p;
  const Utime begin = t;
  while (t < begin + 900'000)
    out = bench.Step(t += out.mode == TrackerMode::kTracking ? 25'000 : 10'000, other);
  ASSERT_EQ(out.mode, TrackerMode::kLost);
  ASSERT_GT((motion.State(ToSeconds(t)).T_map_body.p - before).norm(),
            0.3);  // far beyond what a single start finds
  for (int k = 0; k < 60 && out.mode != TrackerMode::kTracking; ++k)
    out = bench.Step(t += 10'000, bench.room);
  ASSERT_EQ(out.mode, TrackerMode::kTracking) << out.reason;
  EXPECT_LT((out.nodes.back().state.T_map_body.p - motion.State(ToSeconds(t)).T_map_body.p).norm(), 0.02);
}

TEST(Tracker, AsksForAViewFartherAlongTheMotionThatDoesForTheNextKeyframeToo) {
  const Motion motion{0.4, 0.3};
  TrackerOptions options = TestOptions();
  options.points.margin_px = 60;
  Bench bench(options, motion.State(1.0).T_map_body);
  bench.motion = motion;
  Utime t = 1'000'000;
  ASSERT_EQ(bench.UntilTracking(&t).mode, TrackerMode::kTracking);
  int farther = 0;
  for (int k = 0; k < 40; ++k) {
    ASSERT_EQ(bench.Step(t += 25'000, bench.room).mode, TrackerMode::kTracking);
    KeyframeInput next;
    next.t = t + 25'000;
    next.imu = motion.Samples(t, next.t, bench.bias);
    const VisibilityQuery needed = bench.tracker->QueryAfter(next), asked = bench.tracker->QueryBeyond(next);
    EXPECT_TRUE(bench.tracker->Suffices(asked, needed));
    const Eigen::Vector3d step = needed.T_map_camera.p - bench.tracker->state().T_map_body.p,
                          lead = asked.T_map_camera.p - needed.T_map_camera.p;
    const Eigen::Vector3d v = bench.tracker->state().velocity;
    farther += lead.dot(v) > 0 && step.norm() > 0 ? 1 : 0;
  }
  EXPECT_GT(farther, 25);
}

TEST(Tracker, LateEventsCountAlongTheMotion) {
  constexpr double kSigma = 0.01;  // s
  const Motion motion;
  Utime t = 0;
  Matrix6d with = Matrix6d::Zero(), without = Matrix6d::Zero();
  for (Matrix6d* covariance : {&without, &with}) {
    TrackerOptions options = TestOptions();
    options.window.stamp_sigma_us = covariance == &with ? 1e6 * kSigma : 0;
    t = 1'000'000;
    Bench bench(options, motion.State(ToSeconds(t)).T_map_body);
    TrackerOutput out;
    for (int k = 0; k < 80; ++k)
      out = bench.Step(t += out.mode == TrackerMode::kTracking ? 25'000 : 10'000, bench.room);
    ASSERT_EQ(out.mode, TrackerMode::kTracking) << out.reason;
    *covariance = out.covariance;
  }
  Vector6d moved;
  moved << motion.State(ToSeconds(t)).velocity, motion.Imu(t, {}).gyro;
  moved *= kSigma;
  EXPECT_LT((with - without - moved * moved.transpose()).norm(), 0.1 * moved.squaredNorm());
}

// Until it is lost: nothing that a tracker decides may go by how well the extrinsics are known.
TEST(Tracker, UncertainExtrinsicsAreReportedAndChangeNoPose) {
  Rig rig = TestRig();
  rig.T_body_camera_sigma = {{0.01, 0.02, 0.03}, {0.3, 0.1, 0.2}};  // beyond the limit of the position
  const auto other = synthetic::RoomPoints(60, 99);
  for (const bool event_only : {false, true}) {
    TrackerOptions options = TestOptions();
    options.event_only = event_only;
    Utime t = 1'000'000;
    const SE3 start = Motion().State(ToSeconds(t)).T_map_body;
    Bench exact(options, start), uncertain(options, start, rig);
    const int in_map = event_only ? 100 : 60, most = event_only ? 110 : 150;
    int reported = 0, coasted = 0;
    for (int k = 0; k < most && exact.tracker->mode() != TrackerMode::kLost; ++k) {
      t += event_only ? 3'333 : exact.tracker->mode() == TrackerMode::kTracking ? 25'000 : 10'000;
      const auto& seen = k < in_map ? exact.room : other;
      const TrackerOutput a = exact.Step(t, seen), b = uncertain.Step(t, seen);
      ASSERT_EQ(a.mode, b.mode) << k;
      ASSERT_EQ(a.reason, b.reason) << k;
      ASSERT_EQ(a.useful_interval, b.useful_interval) << k;
      ASSERT_EQ(a.information, b.information) << k;
      ASSERT_EQ(a.nodes.size(), b.nodes.size()) << k;
      if (a.nodes.empty()) continue;
      const SE3& pose = b.nodes.back().state.T_map_body;
      ASSERT_EQ(a.nodes.back().state.T_map_body.p, pose.p) << k;
      ASSERT_EQ(a.nodes.back().state.T_map_body.q.coeffs(), pose.q.coeffs()) << k;
      if (a.mode != TrackerMode::kTracking) continue;
      ASSERT_LT((b.covariance - a.covariance - ExtrinsicsCovariance(pose, rig)).norm(), 1e-9) << k;
      ++reported;
      coasted += k < in_map ? 0 : 1;
      if (event_only && k == in_map) break;  // it does not coast
    }
    EXPECT_EQ(exact.tracker->mode(), event_only ? TrackerMode::kTracking : TrackerMode::kLost);
    EXPECT_GT(reported, 20);
    EXPECT_GT(coasted, event_only ? -1 : 5);
  }
}

}  // namespace
}  // namespace evit
