#include "common/tracking/tracker.h"

#include <gtest/gtest.h>

#include <random>

#include "common/tracking/synthetic_scene.h"

namespace evit {
namespace {

using synthetic::Motion;

config::Tracker Config() {
  config::Tracker c;
  auto* k = c.mutable_keyframes();
  k->set_min_events(1000);
  auto* p = c.mutable_points();
  p->set_max_active(5000), p->set_per_keyframe(600), p->set_margin_px(40), p->set_min_depth_m(0.1);
  p->set_max_depth_m(12), p->set_occlusion(false), p->set_seed(1);
  auto* w = c.mutable_window();
  w->set_size(5), w->set_kernel(config::Window::CAUCHY), w->set_first_node(config::Window::PRIOR);
  w->set_image_sigma(80), w->set_robust_scale(80), w->set_max_iterations(12), w->set_imu_noise_factor(2);
  w->set_motion_model(2);
  auto* b = c.mutable_bootstrap();
  b->set_min_frames(10), b->set_min_displacement_m(0.05), b->set_min_rotation_deg(5),
      b->set_max_duration_s(2);
  b->set_max_gyro_bias(0.1), b->set_max_accel_bias(0.6);
  auto* f = c.mutable_failure();
  c.mutable_bootstrap()->set_min_contrast(0.15), f->set_min_contrast(0.15), f->set_max_coast_s(0.3),
      f->set_max_position_sigma_m(0.2), f->set_max_speed(6), f->set_max_gyro_bias(0.2);
  f->set_max_accel_bias(1.5), f->set_max_imu_gap_ms(200);
  return c;
}

Rig MakeRig() {
  Rig rig;
  rig.camera = synthetic::VgaCamera();
  rig.T_body_camera = synthetic::BodyCamera();
  rig.imu_noise = {7e-4, 1.3e-3, 7e-6, 6e-5};
  rig.imu_rate_hz = 200;
  return rig;
}

// Drives a tracker over a synthetic room: the job of frame_builder and map_server.
struct Bench {
  Motion motion;
  std::vector<Eigen::Vector3f> room = synthetic::RoomPoints();
  AlignmentSettings settings = synthetic::Alignment();
  ImuBias bias{{0.004, -0.003, 0.002}, {0.03, -0.04, 0.02}};
  Tracker tracker;
  std::int64_t seq = 0;
  Utime last = 0, clock = 0;  // us to add to all stamps

  explicit Bench(const config::Tracker& config, const SE3& start) : tracker(MakeRig(), config, start) {}

  TrackerOutput Step(Utime t, const std::vector<Eigen::Vector3f>& seen_points) {
    const VisibilityQuery query = tracker.NextQuery();
    std::vector<std::int32_t> ids;
    std::vector<Eigen::Vector3f> points;
    const SE3 T = query.T_world_camera.Inverse();
    for (std::size_t k = 0; k < room.size(); ++k) {
      Eigen::Vector2d uv;
      if (!query.camera.Project(T * room[k].cast<double>(), &uv) ||
          !query.camera.Contains(uv, -query.margin_px))
        continue;
      ids.push_back(static_cast<std::int32_t>(k));
      points.push_back(room[k]);
    }
    tracker.AddVisible(ids, points);
    KeyframeInput k;
    k.t = t + clock;
    k.seq = seq++;
    k.n_events = seen_points.empty() ? 100 : 20000;
    k.surface = synthetic::DrawSurface(settings, seen_points, motion.State(ToSeconds(t)).T_world_body);
    if (last > 0) k.imu = motion.Samples(last, t, bias);
    for (ImuSample& s : k.imu) s.t += clock;
    k.imu_gap = 5000;
    last = t;
    return tracker.Process(k);
  }
};

TEST(Tracker, BootstrapsAndTracksASyntheticRoom) {
  const Motion motion;
  const SE3 start = motion.State(1.0).T_world_body.Plus(
      (Eigen::Matrix<double, 6, 1>() << 0.02, -0.02, 0.01, 0.01, -0.01, 0.01).finished());
  for (const auto first : {config::Window::PRIOR, config::Window::FIXED}) {
    config::Tracker config = Config();
    config.mutable_window()->set_first_node(first);
    // A fixed first node can only be corrected through the slack of the IMU terms.
    if (first == config::Window::FIXED) config.mutable_window()->set_imu_noise_factor(50);
    Bench bench(config, start);
    Utime t = 1'000'000;
    TrackerOutput out;
    double worst = 0, worst_angle = 0;
    int tracked = 0;
    for (int k = 0; k < 160; ++k) {
      out = bench.Step(t, bench.room);
      if (out.mode == TrackerMode::kTracking) {
        ++tracked;
        const SE3 truth = motion.State(ToSeconds(t)).T_world_body;
        worst = std::max(worst, (out.nodes.back().state.T_world_body.p - truth.p).norm());
        worst_angle = std::max(worst_angle, AngularDistance(truth.q, out.nodes.back().state.T_world_body.q));
      }
      t += out.mode == TrackerMode::kTracking ? 25'000 : 10'000;
    }
    EXPECT_EQ(out.mode, TrackerMode::kTracking) << out.reason;
    EXPECT_GT(tracked, 80);
    EXPECT_LT(worst, 0.006);
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
    Bench bench(Config(), motion.State(1.0).T_world_body);
    TrackerOutput out;
    for (Utime t = 1'000'000; t < 1'500'000; t += 10'000) out = bench.Step(t, bench.room);
    results.push_back(out.nodes.back().state.T_world_body);
  }
  EXPECT_EQ(results[0].p, results[1].p);
  EXPECT_EQ(results[0].q.coeffs(), results[1].q.coeffs());
}

TEST(Tracker, SaysLostWhenTheWorldIsNotTheMap) {
  const Motion motion;
  Bench bench(Config(), motion.State(1.0).T_world_body);
  Utime t = 1'000'000;
  TrackerOutput out;
  while (out.mode != TrackerMode::kTracking && t < 3'000'000) out = bench.Step(t += 10'000, bench.room);
  ASSERT_EQ(out.mode, TrackerMode::kTracking);
  const auto other = synthetic::RoomPoints(60, 99);
  for (int k = 0; k < 40 && out.mode == TrackerMode::kTracking; ++k) out = bench.Step(t += 25'000, other);
  EXPECT_EQ(out.mode, TrackerMode::kLost);
  EXPECT_FALSE(out.has_pose);
  EXPECT_NE(out.reason, "");
}

TEST(Tracker, FindsTheMapAgainWhileTheBodyMoves) {
  const Motion motion{0.4, 0.3};
  config::Tracker config = Config();
  config.mutable_failure()->set_max_coast_s(0.2);
  Bench bench(config, motion.State(1.0).T_world_body);
  bench.motion = motion;
  Utime t = 1'000'000;
  TrackerOutput out;
  while (out.mode != TrackerMode::kTracking && t < 3'000'000) out = bench.Step(t += 10'000, bench.room);
  ASSERT_EQ(out.mode, TrackerMode::kTracking);
  for (int k = 0; k < 20; ++k) out = bench.Step(t += 25'000, bench.room);
  const auto other = synthetic::RoomPoints(60, 99);
  const Eigen::Vector3d before = motion.State(ToSeconds(t)).T_world_body.p;
  const Utime begin = t;
  while (t < begin + 900'000)
    out = bench.Step(t += out.mode == TrackerMode::kTracking ? 25'000 : 10'000, other);
  ASSERT_EQ(out.mode, TrackerMode::kLost);
  ASSERT_GT((motion.State(ToSeconds(t)).T_world_body.p - before).norm(),
            0.3);  // far beyond what a single start finds
  for (int k = 0; k < 60 && out.mode != TrackerMode::kTracking; ++k)
    out = bench.Step(t += 10'000, bench.room);
  ASSERT_EQ(out.mode, TrackerMode::kTracking) << out.reason;
  EXPECT_LT((out.nodes.back().state.T_world_body.p - motion.State(ToSeconds(t)).T_world_body.p).norm(), 0.02);
}

TEST(Tracker, CoastsOnTheImuWhileThereAreNoEvents) {
  const Motion motion;
  config::Tracker config = Config();
  config.mutable_failure()->set_max_coast_s(1.5);
  Bench bench(config, motion.State(1.0).T_world_body);
  Utime t = 1'000'000;
  TrackerOutput out;
  while (out.mode != TrackerMode::kTracking && t < 3'000'000) out = bench.Step(t += 10'000, bench.room);
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
    return (out.nodes.back().state.T_world_body.p - motion.State(ToSeconds(t)).T_world_body.p).norm();
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

TEST(Tracker, EventOnlyTracksWithoutTheImu) {
  const Motion motion;
  config::Tracker config = Config();
  config.set_method(config::Tracker::EVT);
  config.mutable_window()->set_motion_model(0);
  Bench bench(config, motion.State(1.0).T_world_body);
  bench.bias = {{9, 9, 9}, {99, 99, 99}};  // nothing of it is used
  TrackerOutput out;
  for (Utime t = 1'000'000; t <= 2'000'000; t += 3'333) {
    out = bench.Step(t, bench.room);
    ASSERT_EQ(out.mode, TrackerMode::kTracking);
    ASSERT_TRUE(out.has_pose);
    EXPECT_LT((out.nodes.back().state.T_world_body.p - motion.State(ToSeconds(t)).T_world_body.p).norm(),
              0.02);
  }
  EXPECT_GT(out.covariance(0, 0), 0);
  const auto other = synthetic::RoomPoints(60, 99);
  for (int k = 0; k < 60; ++k) out = bench.Step(2'003'333 + k * 3'333, other);
  EXPECT_EQ(out.mode, TrackerMode::kLost);
}

TEST(Tracker, AClockThatJumpsIsSaidAndTrackingResumes) {
  for (const Utime jump : {Utime{-5'000'000}, Utime{3'600'000'000}}) {
    const Motion motion;
    Bench bench(Config(), motion.State(1.0).T_world_body);
    Utime t = 1'000'000;
    TrackerOutput out;
    while (out.mode != TrackerMode::kTracking && t < 3'000'000) out = bench.Step(t += 10'000, bench.room);
    ASSERT_EQ(out.mode, TrackerMode::kTracking);
    bench.clock += jump;
    bench.last = 0;  // frame_builder starts anew
    out = bench.Step(t += 10'000, bench.room);
    EXPECT_EQ(out.mode, TrackerMode::kBootstrapping);
    for (int k = 0; k < 60 && out.mode != TrackerMode::kTracking; ++k)
      out = bench.Step(t += 10'000, bench.room);
    EXPECT_EQ(out.mode, TrackerMode::kTracking) << jump;
  }
}

TEST(Tracker, ASolveCutShortKeepsTheBestSoFar) {
  const Motion motion;
  Bench bench(Config(), motion.State(1.0).T_world_body);
  Utime t = 1'000'000;
  TrackerOutput out;
  while (out.mode != TrackerMode::kTracking && t < 3'000'000) out = bench.Step(t += 10'000, bench.room);
  ASSERT_EQ(out.mode, TrackerMode::kTracking);
  int whole = 0, cut = 0;
  for (int k = 0; k < 20; ++k) whole += bench.Step(t += 25'000, bench.room).iterations;
  bench.tracker.set_solve_budget(1e-9);
  bench.tracker.set_point_share(0.25);
  for (int k = 0; k < 20; ++k) {
    out = bench.Step(t += 25'000, bench.room);
    cut += out.iterations;
    EXPECT_LE(out.quality.n_points, 150);
  }
  EXPECT_LT(cut, whole);
  EXPECT_EQ(out.mode, TrackerMode::kTracking) << out.reason;  // prediction and warm start carry it
  EXPECT_LT((out.nodes.back().state.T_world_body.p - motion.State(ToSeconds(t)).T_world_body.p).norm(), 0.03);
}

TEST(Tracker, ImuGapIsReportedAndTrackingResumes) {
  const Motion motion;
  Bench bench(Config(), motion.State(1.0).T_world_body);
  Utime t = 1'000'000;
  TrackerOutput out;
  while (out.mode != TrackerMode::kTracking && t < 3'000'000) out = bench.Step(t += 10'000, bench.room);
  ASSERT_EQ(out.mode, TrackerMode::kTracking);
  KeyframeInput gap;
  gap.t = t += 40'000;
  gap.seq = bench.seq++;
  gap.n_events = 20000;
  gap.surface = synthetic::DrawSurface(bench.settings, bench.room, motion.State(ToSeconds(t)).T_world_body);
  gap.imu = motion.Samples(bench.last, t, bench.bias);
  gap.imu_gap = 300'000;
  bench.last = t;
  out = bench.tracker.Process(gap);
  EXPECT_EQ(out.mode, TrackerMode::kBootstrapping);
  for (int k = 0; k < 60; ++k) out = bench.Step(t += 10'000, bench.room);
  EXPECT_EQ(out.mode, TrackerMode::kTracking) << out.reason;
}

TEST(Bootstrap, FindsVelocitiesAndBiasesFromNoisyPoses) {
  const Motion motion;
  const ImuBias truth{{0.01, -0.008, 0.012}, {0.1, 0.05, -0.08}};
  const ImuNoise noise{7e-4, 1.3e-3, 7e-6, 6e-5};
  std::mt19937 rng(4);
  std::normal_distribution<double> n;
  for (const double pose_noise : {0.0, 1.0}) {
    std::vector<BootstrapFrame> frames;
    for (int k = 0; k <= 60; ++k) {
      const Utime t = 1'000'000 + k * 10'000;
      SE3 pose = motion.State(ToSeconds(t)).T_world_body;
      Eigen::Matrix<double, 6, 1> d;
      for (int c = 0; c < 6; ++c) d[c] = pose_noise * 0.002 * n(rng);
      pose = pose.Plus(d);
      std::shared_ptr<Preintegration> imu;
      if (k > 0)
        imu = std::make_shared<Preintegration>(motion.Samples(t - 10'000, t, truth), ImuBias{}, noise);
      frames.push_back({t, pose, imu});
    }
    const auto result = AlignVisualInertial(frames, 9.81, Config().bootstrap(), 2.0);
    ASSERT_TRUE(result.success) << result.reason;
    const BodyState expected = motion.State(1.6), &got = result.states.back();
    EXPECT_LT((got.velocity - expected.velocity).norm(), pose_noise > 0 ? 0.03 : 0.01);
    EXPECT_LT((got.bias.gyro - truth.gyro).norm(), pose_noise > 0 ? 0.01 : 0.002);
    EXPECT_LT((got.bias.accel - truth.accel).norm(), 0.06);
  }
}

TEST(Bootstrap, RefusesAMapWhoseZAxisIsNotUp) {
  const Motion motion;
  const SE3 tilt(ExpSO3({0.3, 0, 0}), {0, 0, 0});
  std::vector<BootstrapFrame> frames;
  for (int k = 0; k <= 40; ++k) {
    const Utime t = 1'000'000 + k * 10'000;
    std::shared_ptr<Preintegration> imu;
    if (k > 0) {
      imu = std::make_shared<Preintegration>(motion.Samples(t - 10'000, t, {}), ImuBias{},
                                             ImuNoise{7e-4, 1.3e-3, 7e-6, 6e-5});
    }
    frames.push_back({t, tilt * motion.State(ToSeconds(t)).T_world_body, imu});
  }
  const auto result = AlignVisualInertial(frames, 9.81, Config().bootstrap(), 2.0);
  EXPECT_FALSE(result.success);
  EXPECT_NE(result.reason.find("z axis"), std::string::npos);
}

}  // namespace
}  // namespace evit
