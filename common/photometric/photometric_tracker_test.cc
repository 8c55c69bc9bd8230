#include "common/photometric/photometric_tracker.h"

#include <gtest/gtest.h>

#include "common/photometric/view_renderer.h"
#include "common/tracking/pose_covariance.h"
#include "tests/helpers/photometric_room.h"

namespace evit {
namespace {

constexpr double kContrast = 0.25;

PhotometricTrackerOptions Options() {
  PhotometricTrackerOptions o;
  o.min_events = 200;
  o.lag_px = o.map_sigma_m = o.stamp_sigma_us = 0;
  o.photometric.contrast_threshold = kContrast;
  o.photometric.max_points = 3000;
  o.photometric.min_gradient = 0.03;
  o.photometric.min_correlation = 0.6;
  o.photometric.max_bad_s = 0.2;
  return o;
}

// Plays frame_builder and map_server in a synthetic room.
struct Bench {
  static constexpr Utime kInterval = 20'000;
  test::Room room;
  Rig rig;
  ViewRenderer renderer{test::Room().Map(0.012), test::Room::kDark};
  PhotometricTracker tracker;
  std::int64_t seq = 0;
  PhotometricView before;

  static Rig MakeRig() {
    Rig rig;
    rig.camera = test::EventCamera();
    rig.T_body_camera = test::BodyCamera();
    return rig;
  }
  explicit Bench(const SE3& start, const PhotometricTrackerOptions& options = Options(),
                 const Rig& with_rig = MakeRig())
      : rig(with_rig), tracker(rig, options, start) {}

  static SE3 Truth(Utime t) {
    const double s = ToSeconds(t);
    return {ExpSO3({0.5 + 0.1 * std::sin(2 * s), 0.12 * std::sin(1.7 * s), 0.15 * std::sin(1.4 * s)}),
            0.1 * Eigen::Vector3d(std::sin(1.5 * s), std::sin(1.9 * s), std::sin(1.2 * s))};
  }
  TrackerOutput Step(Utime t) {
    const auto see = [&](Utime at) { return room.See(rig.camera, Truth(at) * rig.T_body_camera); };
    PhotometricFrame frame;
    frame.t = t;
    frame.seq = seq++;
    frame.begin = t - kInterval / 2;
    frame.end = t + kInterval / 2;
    if (before.log_intensity.empty()) before = see(frame.begin);
    PhotometricView after = see(frame.end);
    frame.counts = test::CountBetween(before, after, kContrast);
    before = std::move(after);
    frame.n_events = cv::countNonZero(frame.counts != 128);
    PhotometricView view;
    renderer.Render(tracker.NextQuery(), &view);
    tracker.SetView(view);
    return tracker.Process(frame);
  }
};

TEST(PhotometricTracker, TracksASyntheticRoomFromARoughStart) {
  Bench bench(Bench::Truth(1'000'000).Plus((Vector6d() << 0.02, -0.02, 0.015, 0.01, -0.01, 0.01).finished()));
  TrackerOutput out;
  double squares = 0, worst_angle = 0;
  int n = 0;
  for (Utime t = 1'000'000; t < 2'600'000; t += Bench::kInterval) {
    out = bench.Step(t);
    ASSERT_TRUE(out.has_pose) << t << " " << out.reason;
    if (t < 1'200'000) continue;
    const SE3 truth = Bench::Truth(t), got = out.nodes.back().state.T_map_body;
    squares += (got.p - truth.p).squaredNorm();
    worst_angle = std::max(worst_angle, AngularDistance(got.q, truth.q));
    const Eigen::Vector3d velocity = (Bench::Truth(t + 1000).p - truth.p) / 1e-3;
    EXPECT_LT((out.nodes.back().state.velocity - velocity).norm(), 0.15);
    ++n;
  }
  EXPECT_LT(std::sqrt(squares / n), 0.008);
  EXPECT_LT(worst_angle, 0.01);
  EXPECT_EQ(out.mode, TrackerMode::kTracking);
  EXPECT_GT(out.image_speed, 5);
  EXPECT_GT(out.quality.inlier_share, 0.5);
  EXPECT_GT(out.covariance.diagonal().minCoeff(), 0);
}

TEST(PhotometricTracker, LateEventsCountAlongTheMotionInTheBodysFrame) {
  constexpr double kSigma = 0.01;  // s
  constexpr Utime kEnd = 1'300'000;
  Matrix6d with = Matrix6d::Zero(), without = Matrix6d::Zero();
  for (Matrix6d* covariance : {&without, &with}) {
    PhotometricTrackerOptions options = Options();
    options.stamp_sigma_us = covariance == &with ? 1e6 * kSigma : 0;
    Bench bench(Bench::Truth(1'000'000), options);
    for (Utime t = 1'000'000; t <= kEnd; t += Bench::kInterval) *covariance = bench.Step(t).covariance;
  }
  const SE3 truth = Bench::Truth(kEnd), next = Bench::Truth(kEnd + 1000);
  Vector6d moved;
  moved << next.p - truth.p, LogSO3(truth.q.conjugate() * next.q);
  moved *= kSigma / 1e-3;
  const Matrix6d late = with - without;
  EXPECT_LT((late - moved * moved.transpose()).norm(), 0.3 * moved.squaredNorm());
  const double of_rotation = late.bottomRightCorner<3, 3>().trace();
  const Eigen::Vector3d turned = moved.tail<3>().normalized();
  EXPECT_GT(turned.dot(late.bottomRightCorner<3, 3>() * turned), 0.9 * of_rotation);
}

TEST(PhotometricTracker, UncertainExtrinsicsAreReportedAndChangeNoPose) {
  Rig rig = Bench::MakeRig();
  rig.T_body_camera_sigma = {{0.01, 0.02, 0.03}, {0.003, 0.001, 0.002}};
  const SE3 start = Bench::Truth(1'000'000);
  Bench exact(start), uncertain(start, Options(), rig);
  for (Utime t = 1'000'000; t <= 1'200'000; t += Bench::kInterval) {
    const TrackerOutput a = exact.Step(t), b = uncertain.Step(t);
    const SE3& pose = b.nodes.back().state.T_map_body;
    EXPECT_EQ(a.nodes.back().state.T_map_body.p, pose.p);
    EXPECT_LT((b.covariance - a.covariance - ExtrinsicsCovariance(pose, rig)).norm(), 1e-12);
  }
}

TEST(PhotometricTracker, TheSameInputGivesTheSameBits) {
  std::vector<SE3> ends;
  for (int run = 0; run < 2; ++run) {
    Bench bench(Bench::Truth(1'000'000));
    TrackerOutput out;
    for (Utime t = 1'000'000; t < 1'200'000; t += Bench::kInterval) out = bench.Step(t);
    ends.push_back(out.nodes.back().state.T_map_body);
  }
  EXPECT_EQ(ends[0].p, ends[1].p);
  EXPECT_EQ(ends[0].q.coeffs(), ends[1].q.coeffs());
}

TEST(PhotometricTracker, SaysLostWhereTheMapPredictsNothingAndComesBackWithAHint) {
  Bench bench(Bench::Truth(1'000'000));
  Utime t = 1'000'000;
  TrackerOutput out;
  for (; t < 1'200'000; t += Bench::kInterval) out = bench.Step(t);
  ASSERT_EQ(out.mode, TrackerMode::kTracking);
  bench.room.phase = 2;  // other pictures on the walls
  bench.before.log_intensity.clear();
  const auto sigma = [&] { return std::sqrt(out.covariance.topLeftCorner<3, 3>().trace()); };
  double before = sigma();
  EXPECT_LT(before, 0.05);
  bool coasted = false;
  for (; t < 1'700'000; t += Bench::kInterval) {
    out = bench.Step(t);
    if (out.mode == TrackerMode::kLost) break;
    if (out.reason.rfind("coasting", 0) != 0) continue;
    coasted = true;
    EXPECT_GT(sigma(), before);
    before = sigma();
  }
  EXPECT_EQ(out.mode, TrackerMode::kLost);
  EXPECT_FALSE(out.has_pose);
  EXPECT_NE(out.reason.find("does not predict the events"), std::string::npos) << out.reason;
  EXPECT_TRUE(coasted);
  bench.room.phase = 0;
  bench.before.log_intensity.clear();
  bench.tracker.Start(Bench::Truth(t));
  for (const Utime end = t + 200'000; t < end; t += Bench::kInterval) out = bench.Step(t);
  EXPECT_EQ(out.mode, TrackerMode::kTracking);
  EXPECT_LT((out.nodes.back().state.T_map_body.p - Bench::Truth(t - Bench::kInterval).p).norm(), 0.02);
}

TEST(PhotometricTracker, WithoutEventsItWaits) {
  PhotometricTracker tracker(Bench::MakeRig(), Options(), {});
  PhotometricFrame frame;
  frame.t = frame.end = 1'000'000;
  frame.counts = cv::Mat(240, 320, CV_8UC1, cv::Scalar(128));
  TrackerOutput out = tracker.Process(frame);
  EXPECT_EQ(out.mode, TrackerMode::kBootstrapping);
  EXPECT_FALSE(out.has_pose);
  frame.n_events = 50'000;  // but none that count, and no view
  frame.begin = 990'000;
  frame.t = frame.end = 1'010'000;
  out = tracker.Process(frame);
  EXPECT_EQ(out.mode, TrackerMode::kBootstrapping);
  EXPECT_NE(out.reason, "");
}

}  // namespace
}  // namespace evit
