#include "common/tracking/window_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/helpers/tracking_bench.h"

namespace evit {
namespace {

// Starts from a known state, with keyframes every 25 ms of a room that is in view as a whole.
class WindowTrackerTest : public ::testing::Test {
 protected:
  WindowTrackerTest() {
    points_.Add(source_.Ids(), source_.room, {});
    source_.last = t_;
    state_ = source_.motion.State(ToSeconds(t_));
    state_.bias = source_.bias;
  }
  void Start() {
    Matrix15d information = Matrix15d::Zero();
    information.diagonal() << Vector6d::Constant(1e6), Eigen::Matrix<double, 9, 1>::Constant(1e4);
    window_.Start(t_, state_, information);
  }
  WindowTracker::Result Step(const std::vector<Eigen::Vector3f>& seen_points) {
    const KeyframeInput keyframe = source_.Next(t_ += 25'000, seen_points);
    out_ = {};
    return window_.Process(keyframe, keyframe.imu.back().gyro - source_.bias.gyro, &out_);
  }

  TrackerOptions options_ = TestOptions();
  KeyframeSource source_;
  PointSelector points_{TestRig(), source_.settings, options_.points, options_.lag_px};
  WindowTracker window_{TestRig(), options_, source_.settings, &points_};
  Utime t_ = 1'000'000;
  BodyState state_;
  TrackerOutput out_;
};

TEST_F(WindowTrackerTest, FollowsTheBody) {
  Start();
  for (int k = 0; k < 20; ++k) {
    const WindowTracker::Result result = Step(source_.room);
    ASSERT_EQ(result.failure, "");
    ASSERT_EQ(result.coasting, "");
    EXPECT_LT((window_.state().T_map_body.p - source_.Truth(t_).p).norm(), 0.006);
  }
  EXPECT_EQ(window_.nodes().size(), static_cast<std::size_t>(options_.window.size));
  EXPECT_GT(out_.quality.contrast(), options_.failure.min_contrast);
  EXPECT_GT(out_.covariance.diagonal().minCoeff(), 0);
}

TEST_F(WindowTrackerTest, CoastsWithoutEventsUntilItHasLastedTooLong) {
  Start();
  for (int k = 0; k < 5; ++k) Step(source_.room);
  const double known = out_.covariance(0, 0);
  const Utime begin = t_;
  WindowTracker::Result result;
  while (t_ < begin + 250'000) {
    result = Step({});
    ASSERT_EQ(result.failure, "");
    EXPECT_EQ(result.coasting, "no events");
  }
  EXPECT_GT(out_.covariance(0, 0), known);
  EXPECT_LT((window_.state().T_map_body.p - source_.Truth(t_).p).norm(), 0.05);
  while (t_ < begin + 350'000) result = Step({});
  EXPECT_EQ(result.failure.substr(0, 13), "no events for");
  EXPECT_EQ(result.restart.T_map_body.p, window_.state().T_map_body.p);
}

// At rest, or moving evenly: the IMU reads the same.
class EvenMotion : public WindowTrackerTest {
 protected:
  // Known to 2 mm, 1 cm/s and 2 mrad/s.
  void Start(const Eigen::Vector3d& velocity) {
    state_.velocity = velocity;
    Matrix15d information = Matrix15d::Zero();
    information.diagonal() << Vector6d::Constant(2.5e5), Eigen::Vector3d::Constant(1e4),
        Eigen::Vector3d::Constant(2.5e5), Eigen::Vector3d::Constant(2.5e3);
    window_.Start(t_, state_, information);
  }
  WindowTracker::Result Step(int n_events, const Eigen::Vector3d& push = Eigen::Vector3d::Zero(),
                             Utime interval = 50'000) {
    KeyframeInput keyframe = source_.Next(t_ += interval, synthetic::RoomPoints(60, 99));
    keyframe.n_events = n_events;
    const Eigen::Vector3d up(0, 0, source_.motion.gravity);
    for (ImuSample& s : keyframe.imu)
      s = {s.t, source_.bias.gyro, state_.T_map_body.q.conjugate() * up + source_.bias.accel + push};
    out_ = {};
    return window_.Process(keyframe, Eigen::Vector3d::Zero(), &out_);
  }
};

TEST_F(EvenMotion, ABodyThatStandsStillStaysWhereItIs) {
  constexpr double kMostSigma = 0.04;  // m
  options_.failure.max_position_sigma_m = kMostSigma;
  window_ = WindowTracker(TestRig(), options_, source_.settings, &points_);
  for (const int n_events : {0, 20'000}) {  // dark, or noise that the map does not lie on
    Start(0.01 * Eigen::Vector3d::UnitX());
    const Utime begin = t_, interval = n_events == 0 ? 200'000 : 50'000;  // as KeyframePolicy has them
    for (int k = 0; k < 400; ++k) {                                       // coasting may take 0.3 s
      const WindowTracker::Result result = Step(n_events, Eigen::Vector3d::Zero(), interval);
      ASSERT_EQ(result.failure, "") << k;
      ASSERT_NE(result.coasting, "");
      ASSERT_EQ(result.stands_still, t_ - begin >= 250'000) << k;
    }
    EXPECT_LT((window_.state().T_map_body.p - state_.T_map_body.p).norm(), 0.02);
    EXPECT_LT(window_.state().velocity.norm(), 0.002);
    // To begin with the position must be known to a third of that; the walk of 80 s leads beyond.
    const double sigma = std::sqrt(out_.covariance.diagonal().head<3>().maxCoeff());
    EXPECT_LT(sigma, 0.03);
    EXPECT_GT(sigma, n_events == 0 ? kMostSigma / 3 : 0);
    EXPECT_LT(std::sqrt(out_.covariance.diagonal().tail<3>().maxCoeff()), 0.02);
  }
  EXPECT_FALSE(Step(0, Eigen::Vector3d(0, 1, 0)).stands_still);
}

// Too gently for a quarter of a second to show it.
TEST_F(EvenMotion, AGentleStartEndsAStandstill) {
  Start(Eigen::Vector3d::Zero());
  for (int k = 0; k < 40; ++k) ASSERT_EQ(Step(0).failure, "");
  WindowTracker::Result result;
  double speed = 0;
  for (int k = 0; k < 60 && result.failure.empty(); ++k, speed += 0.05 * 0.09)
    result = Step(0, Eigen::Vector3d(0, 0.09, 0));
  EXPECT_EQ(result.failure.substr(0, 13), "no events for");
  EXPECT_LT(speed, 0.2);  // of these the last 0.3 s are coasting
}

TEST_F(EvenMotion, EvenMotionIsNoStandstill) {
  Start(0.3 * Eigen::Vector3d::UnitX());
  WindowTracker::Result result;
  for (int k = 0; k < 7; ++k) {
    result = Step(0);
    EXPECT_FALSE(result.stands_still) << k;
  }
  EXPECT_EQ(result.failure.substr(0, 13), "no events for");
}

TEST_F(WindowTrackerTest, AFewEventsAreNotNone) {
  Start();
  for (int k = 0; k < 5; ++k) Step(source_.room);
  KeyframeInput keyframe = source_.Next(t_ += 25'000, source_.room);
  keyframe.n_events = 7;
  out_ = {};
  const Eigen::Vector3d rate = keyframe.imu.back().gyro - source_.bias.gyro;
  EXPECT_EQ(window_.Process(keyframe, rate, &out_).coasting, "too few events");
}

TEST_F(WindowTrackerTest, EventsTheMapDoesNotLieOnDoNotPull) {
  Start();
  for (int k = 0; k < 5; ++k) Step(source_.room);
  const WindowTracker::Result result = Step(synthetic::RoomPoints(60, 99));
  EXPECT_EQ(result.coasting, "the map does not lie on the events");
  EXPECT_LT((window_.state().T_map_body.p - source_.Truth(t_).p).norm(), 0.006);
}

// A seventh of what is seen is in the map: while tracking that is enough. After long coasting it is not, as
// noise may look the same; the whole room is.
TEST_F(WindowTrackerTest, AfterLongCoastingAPoseMustFitAsWellAsAStart) {
  options_.failure.max_coast_s = 2;
  options_.failure.max_position_sigma_m = 1;
  std::vector<Eigen::Vector3f> partly = synthetic::RoomPoints(60, 99);
  partly.insert(partly.end(), source_.room.begin(), source_.room.begin() + 600);  // 10 lines
  for (const int coasted : {0, 24}) {
    WindowTracker tracker(TestRig(), options_, source_.settings, &points_);
    source_ = KeyframeSource();
    source_.last = t_ = 1'000'000;
    Matrix15d information = Matrix15d::Zero();
    information.diagonal() << Vector6d::Constant(1e6), Eigen::Matrix<double, 9, 1>::Constant(1e4);
    tracker.Start(t_, state_, information);
    const auto step = [&](const std::vector<Eigen::Vector3f>& seen) {
      const KeyframeInput keyframe = source_.Next(t_ += 25'000, seen);
      return tracker.Process(keyframe, keyframe.imu.back().gyro - source_.bias.gyro, &out_).coasting;
    };
    for (int k = 0; k < 5; ++k) ASSERT_EQ(step(source_.room), "");
    for (int k = 0; k < coasted; ++k) ASSERT_EQ(step({}), "no events");
    EXPECT_EQ(step(partly), coasted == 0 ? "" : "the map does not lie on the events");
    EXPECT_EQ(step(source_.room), "");
  }
}

// As bootstrapping starts it. Where the start was a false one the events tell within a few keyframes, long
// before coasting has lasted too long.
TEST_F(WindowTrackerTest, NoticesWithinFiveKeyframesThatTheStartWasFalse) {
  const std::vector<Eigen::Vector3f> room = source_.room, other = synthetic::RoomPoints(60, 99);
  for (const std::vector<Eigen::Vector3f>* seen : {&room, &other}) {
    source_ = KeyframeSource();
    source_.last = t_ = 1'000'000;
    WindowNode first;
    first.t = t_;
    first.state = state_;
    const cv::Mat surface = synthetic::DrawSurface(source_.settings, *seen, state_.T_map_body);
    first.field = std::make_shared<SurfaceField>(surface, 1);
    first.points = points_.Select(state_, Eigen::Vector3d::Zero(), 600, 0);
    StatePrior prior;
    prior.mean = state_;
    prior.information.diagonal() << Vector6d::Constant(1e6), Eigen::Matrix<double, 9, 1>::Constant(1e4);
    window_.Start({first}, prior);
    WindowTracker::Result result;
    for (int k = 0; k < 5; ++k) result = Step(*seen);
    if (seen == &room) {
      EXPECT_EQ(result.failure, "");
    } else {
      EXPECT_EQ(result.failure, "the map lies on the events no better than at a false pose");
      EXPECT_TRUE(result.restart.velocity.isZero(0));
    }
  }
}

TEST_F(WindowTrackerTest, RestartsFromThePredictionWithoutBiasesWhereTheStateIsImpossible) {
  state_.velocity = {20, 0, 0};
  Start();
  const WindowTracker::Result result = Step({});
  EXPECT_NE(result.failure.find("speed"), std::string::npos) << result.failure;
  EXPECT_TRUE(result.restart.velocity.isZero(0));
  EXPECT_TRUE(result.restart.bias.gyro.isZero(0));
}

}  // namespace
}  // namespace evit
