#include "common/calibration/calibrated_sigma.h"

#include <gtest/gtest.h>

#include <cmath>

namespace evit {
namespace {

Matrix6d Covariance(const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << translation.cwiseAbs2(), rotation.cwiseAbs2();
  return covariance;
}

TEST(CalibratedSigma, IsTheCovariancesByAxis) {
  Matrix6d covariance = Covariance({0.001, 0.002, 0.003}, {0.004, 0.005, 0.006});
  covariance(0, 1) = covariance(1, 0) = 1e-6;
  const ExtrinsicsSigma sigma = CalibratedSigma(covariance, {}, {{1, 1, 1}, {1, 1, 1}});
  EXPECT_TRUE(sigma.translation.isApprox(Eigen::Vector3d(0.001, 0.002, 0.003)));
  EXPECT_TRUE(sigma.rotation.isApprox(Eigen::Vector3d(0.004, 0.005, 0.006)));
}

TEST(CalibratedSigma, AKeptFigureIsKnownAsTheRigFileSaysItIs) {
  // Nothing but 9 cm is known along an axis between the body's x and y; 1 mm across.
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 1, 0).normalized();
  Matrix6d covariance = Covariance({0.001, 0.001, 0.001}, {0.002, 0.002, 0.002});
  covariance.topLeftCorner<3, 3>() += (0.0081 - 1e-6) * axis * axis.transpose();
  const std::vector<Unobservable> unobservable{{Unobservable::Value::kTranslation, axis, 0.09},
                                               {Unobservable::Value::kTilt, axis, 0.09},
                                               {Unobservable::Value::kTimeOffset, {0, 0, 0}, 0.008}};
  const ExtrinsicsSigma stated = CalibratedSigma(covariance, unobservable, {{0, 0, 0}, {0.002, 0.002, 0.02}});
  EXPECT_NEAR(stated.translation.x(), std::sqrt((1e-6 + 4e-6) / 2), 1e-9);
  EXPECT_NEAR(stated.translation.y(), std::sqrt((1e-6 + 4e-6) / 2), 1e-9);
  EXPECT_NEAR(stated.translation.z(), 0.001, 1e-9);
  EXPECT_NEAR(stated.rotation.z(), 0.002, 1e-9);
  // It says nothing: then the recording's word counts.
  const ExtrinsicsSigma silent = CalibratedSigma(covariance, unobservable, {{0.01, 0.01, 0.01}, {0, 0, 0}});
  EXPECT_NEAR(silent.translation.x(), std::sqrt((1e-6 + 0.0081) / 2), 1e-9);
}

TEST(CalibratedSigma, IsWhatARigFileMaySay) {
  const ExtrinsicsSigma sigma = CalibratedSigma(Covariance({9, 9, 9}, {3, 3, 3}), {}, {});
  EXPECT_NEAR(sigma.rotation.x(), 0.34, 1e-9);
  EXPECT_EQ(sigma.translation.x(), 1);
}

}  // namespace
}  // namespace evit
