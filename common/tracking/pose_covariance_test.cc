#include "common/tracking/pose_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "common/geometry/so3.h"

namespace evit {
namespace {

TEST(PoseCovariance, IsThePosesPartOfTheInverse) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const Matrix15d root = Matrix15d::NullaryExpr([&] { return normal(random); });
  const Matrix15d information = root * root.transpose() + Matrix15d::Identity();
  const Matrix6d expected = information.inverse().topLeftCorner<6, 6>();
  EXPECT_LT((PoseCovariance(information) - expected).norm(), 1e-6 * expected.norm());
}

TEST(PoseCovariance, KeyframesThatSeeTheSameEdgesSayLessThanSoManyIndependentOnes) {
  const Matrix15d information = 1e6 * Matrix15d::Identity();
  EXPECT_GT(WindowCovariance(information)(0, 0), 3 * PoseCovariance(information)(0, 0));
  EXPECT_GT(WindowCovariance(information)(5, 5), 3 * PoseCovariance(information)(5, 5));
}

TEST(PoseCovariance, WhatOneKeyframeLeavesOpenStaysButNotWithoutBound) {
  Matrix6d alignment = Matrix6d::Zero();
  alignment.diagonal() << 1e6, 1e6, 0, 1e8, 1e8, 1e8;  // nothing seen along z
  const Matrix6d half = SystematicCovariance(alignment, 0.5, 0.002);
  EXPECT_NEAR(half(0, 0), 0.5e-6 + 4e-6, 1e-8);
  EXPECT_NEAR(half(2, 2), 9e-4 + 4e-6, 1e-8);
  EXPECT_NEAR(half(3, 3), 0.5e-8, 1e-10);
  EXPECT_NEAR(SystematicCovariance(alignment, 0, 0.002)(0, 0), 4e-6, 1e-12);
  EXPECT_EQ(SystematicCovariance(alignment, 0, 0.002)(3, 3), 0);
}

TEST(PoseCovariance, WhatPatchesLieBesideTheirEventsMayBeAShiftOfTheWholeMap) {
  constexpr double kFocal = 300;
  const Matrix6d shifted = MisfitCovariance({100, 0.65, 0.004}, 2, kFocal);  // 0.6 pixels beyond the grid's
  EXPECT_NEAR(std::sqrt(shifted(0, 0)), 2 * 0.6 * 0.004, 1e-6);
  EXPECT_NEAR(std::sqrt(shifted(5, 5)), 2 * 0.6 / kFocal, 1e-6);
  EXPECT_EQ(MisfitCovariance({100, 0.2, 0.004}, 2, kFocal).norm(), 0);
  EXPECT_EQ(MisfitCovariance({100, 0.65, 0.004}, 0, kFocal).norm(), 0);
}

TEST(PoseCovariance, GrowsWithinASecondWhereTheMapIsWrongAndNotByOneKeyframe) {
  Camera camera;
  camera.fx = camera.fy = 300;
  PoseUncertainty uncertainty(camera, WindowOptions());
  const Matrix6d alignment = 1e7 * Matrix6d::Identity();
  const auto sigma = [&] {
    return std::sqrt(uncertainty.Covariance(1e-8 * Matrix6d::Identity(), Eigen::Vector3d::Zero(),
                                            Eigen::Vector3d::Zero())(0, 0));
  };
  for (int k = 0; k < 30; ++k) uncertainty.SetAlignment(alignment, {100, 0.3, 0.004});
  const double before = sigma();
  uncertainty.SetAlignment(alignment, {100, 1.2, 0.004});
  EXPECT_LT(sigma(), 2 * before);
  for (int k = 0; k < 20; ++k) uncertainty.SetAlignment(alignment, {100, 1.2, 0.004});  // a second at most
  EXPECT_GT(sigma(), 5 * before);
  // Too few patches to say so.
  const double after = sigma();
  uncertainty.SetAlignment(alignment, {3, 0.1, 0.004});
  EXPECT_NEAR(sigma(), after, 1e-9);
}

// Poses of a body that keeps moving for as long as its events are late.
TEST(PoseCovariance, LateEventsSpreadPosesAlongTheMotion) {
  const Eigen::Vector3d velocity(0.5, -1, 0.2), rate(2, 0.3, -4);
  constexpr double kSigma = 400e-6;
  const SE3 T_map_body(ExpSO3({0.3, -1.1, 0.4}), {1, 2, 3});
  std::mt19937 random(1);
  std::normal_distribution<double> late(0, kSigma);
  constexpr int kPoses = 20'000;
  Matrix6d spread = Matrix6d::Zero();
  for (int k = 0; k < kPoses; ++k) {
    const double dt = late(random);
    const SE3 then(T_map_body.q * ExpSO3(dt * rate), T_map_body.p + dt * velocity);
    Vector6d error;
    error << then.p - T_map_body.p, LogSO3(T_map_body.q.conjugate() * then.q);
    spread += error * error.transpose() / kPoses;
  }
  const Matrix6d claimed = TimeOffsetCovariance(velocity, rate, kSigma);
  EXPECT_LT((claimed - spread).norm(), 0.03 * spread.norm());
  EXPECT_EQ(TimeOffsetCovariance(velocity, rate, 0).norm(), 0);
}

// A tracker that uses T_body_camera finds the camera where it is, and the body elsewhere.
TEST(PoseCovariance, WrongExtrinsicsMoveTheBodyAndNotTheCamera) {
  Rig rig;
  rig.T_body_camera = SE3(ExpSO3({-1.2, 1.1, -1.3}), {0.13, 0.08, -0.25});
  rig.T_body_camera_sigma = {{0.014, 0.02, 0.007}, {0.002, 0.005, 0.001}};
  const SE3 T_map_body(ExpSO3({0.3, -1.1, 0.4}), {1, 2, 3});
  const SE3 T_map_camera = T_map_body * rig.T_body_camera;
  Matrix6d expected = Matrix6d::Zero();
  for (int k = 0; k < 6; ++k) {
    constexpr double kStep = 1e-5;
    Vector6d by[2];
    for (const int sign : {-1, 1}) {
      Vector6d wrong = Vector6d::Zero();
      wrong[k] = sign * kStep;
      const SE3 T_body_camera(rig.T_body_camera.q * ExpSO3(wrong.tail<3>()),
                              rig.T_body_camera.p + wrong.head<3>());
      const SE3 body = T_map_camera * T_body_camera.Inverse();
      by[(sign + 1) / 2] << body.p - T_map_body.p, LogSO3(T_map_body.q.conjugate() * body.q);
    }
    const Vector6d slope = (by[1] - by[0]) / (2 * kStep);
    const double sigma =
        k < 3 ? rig.T_body_camera_sigma.translation[k] : rig.T_body_camera_sigma.rotation[k - 3];
    expected += sigma * sigma * slope * slope.transpose();
  }
  EXPECT_LT((ExtrinsicsCovariance(T_map_body, rig) - expected).norm(), 1e-8 * expected.norm());
  rig.T_body_camera_sigma = {};
  EXPECT_EQ(ExtrinsicsCovariance(T_map_body, rig).norm(), 0);
}

}  // namespace
}  // namespace evit
