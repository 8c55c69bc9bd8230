#include "common/tracking/motion_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/geometry/so3.h"

namespace evit {
namespace {

constexpr double kStep = 1. / 300;  // s

Matrix6d Known(double position, double rotation) {
  Vector6d information;
  information.head<3>().setConstant(1 / (position * position));
  information.tail<3>().setConstant(1 / (rotation * rotation));
  return information.asDiagonal();
}

// The best pose given prediction and a measured one, as an alignment with a prior would find it.
SE3 Between(const MotionFilter& filter, const SE3& measured, const Matrix6d& information) {
  const SE3& predicted = filter.state().T_map_body;
  Vector6d d;
  d << measured.p - predicted.p, LogSO3(predicted.q.conjugate() * measured.q);
  const Vector6d step = (filter.PoseInformation() + information).ldlt().solve(information * d);
  return {predicted.q * ExpSO3(step.tail<3>()), predicted.p + step.head<3>()};
}

// A body that moves and turns evenly, measured with noise.
class MotionFilterTest : public ::testing::Test {
 protected:
  static SE3 Truth(double t) {
    return {ExpSO3({0.2, 0.1, 0}) * ExpSO3(t * Rate()), Eigen::Vector3d(1, 2, 3) + t * Velocity()};
  }
  static Eigen::Vector3d Velocity() { return {0.5, -0.2, 0.1}; }  // m/s
  static Eigen::Vector3d Rate() { return {0.3, 1.5, -0.6}; }      // rad/s, body frame

  SE3 Measured(double t) {
    const auto noise = [this](double sigma) {
      return Eigen::Vector3d(sigma * normal_(rng_), sigma * normal_(rng_), sigma * normal_(rng_));
    };
    const SE3 truth = Truth(t);
    return {truth.q * ExpSO3(noise(kRotation)), truth.p + noise(kPosition)};
  }
  void Follow(int begin, int end, double* squared) {
    for (int k = begin; k <= end; ++k) {
      filter_.Predict(kStep);
      filter_.Update(Between(filter_, Measured(k * kStep), information_), information_);
      *squared += (filter_.state().T_map_body.p - Truth(k * kStep).p).squaredNorm() / 3;
    }
  }

  static constexpr double kPosition = 0.01, kRotation = 0.01;  // m, rad
  Matrix6d information_ = Known(kPosition, kRotation);
  MotionFilter filter_;
  std::mt19937 rng_{1};
  std::normal_distribution<double> normal_{};
};

TEST_F(MotionFilterTest, LearnsTheVelocitiesAndAveragesTheNoise) {
  filter_.Start(Measured(0), information_);
  EXPECT_EQ(filter_.state().velocity.norm(), 0);
  double squared = 0;
  Follow(1, 150, &squared);
  squared = 0;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero(), rate = Eigen::Vector3d::Zero();
  for (int k = 151; k <= 600; ++k) {
    Follow(k, k, &squared);
    velocity += filter_.state().velocity / 450, rate += filter_.state().rate / 450;
  }
  EXPECT_LT((velocity - Velocity()).norm(), 0.1);
  EXPECT_LT((rate - Rate()).norm(), 0.3);
  EXPECT_LT(std::sqrt(squared / 450), 0.7 * kPosition);
}

TEST_F(MotionFilterTest, ClaimsWhatItKnows) {
  filter_.Start(Measured(0), information_);
  double squared = 0;
  Follow(1, 150, &squared);
  double nees = 0;
  int n = 0;
  for (int run = 0; run < 300; ++run) {
    Follow(151 + run, 151 + run, &squared);
    const SE3 truth = Truth((151 + run) * kStep);
    Vector6d e;
    e << filter_.state().T_map_body.p - truth.p, LogSO3(truth.q.conjugate() * filter_.state().T_map_body.q);
    nees += e.dot(filter_.PoseInformation() * e) / 6;
    ++n;
  }
  // A body that does not accelerate is known better than one that may.
  EXPECT_GT(nees / n, 0.3);
  EXPECT_LT(nees / n, 1.3);
}

TEST_F(MotionFilterTest, MovesOnAndKnowsLessWithTime) {
  filter_.Start(Measured(0), information_);
  double squared = 0;
  Follow(1, 300, &squared);
  const MotionFilter::State before = filter_.state();
  const Matrix6d known = filter_.PoseInformation();
  filter_.Predict(0.1);
  EXPECT_LT((filter_.state().T_map_body.p - (before.T_map_body.p + 0.1 * before.velocity)).norm(), 1e-12);
  EXPECT_LT(filter_.state().T_map_body.q.angularDistance(before.T_map_body.q * ExpSO3(0.1 * before.rate)),
            1e-9);
  EXPECT_LT(filter_.PoseInformation().trace(), 0.5 * known.trace());
  // Twice half as far is as far.
  MotionFilter halves = filter_, whole = filter_;
  halves.Predict(0.02), halves.Predict(0.02), whole.Predict(0.04);
  EXPECT_LT((halves.PoseInformation() - whole.PoseInformation()).norm(),
            1e-3 * whole.PoseInformation().norm());
}

// Events that say nothing of one direction leave it to the motion.
TEST_F(MotionFilterTest, GoesOnWhereNothingIsMeasured) {
  filter_.Start(Measured(0), information_);
  double squared = 0;
  Follow(1, 600, &squared);
  information_(0, 0) = 0;
  const double before = filter_.state().T_map_body.p.x(), speed = filter_.state().velocity.x();
  Follow(601, 630, &squared);
  EXPECT_NEAR(filter_.state().T_map_body.p.x(), before + 30 * kStep * speed, 1e-6);
  EXPECT_NEAR(filter_.state().T_map_body.p.y(), Truth(630 * kStep).p.y(), 0.02);
}

}  // namespace
}  // namespace evit
