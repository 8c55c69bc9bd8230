#include "common/calibration/rig_prior.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "common/geometry/degrees.h"

namespace evit {
namespace {

RigVector Sigma() {
  RigVector sigma;
  sigma << 0.01, 0.01, 0.01, 0.02, 0.02, 0.02, 0.005;
  return sigma;
}

// The update by measurements z = A x + noise of one, at a true x.
RigUpdate Update(const Eigen::Matrix<double, Eigen::Dynamic, 7>& A, const RigVector& truth,
                 double lag_sigma = 0) {
  RigVector sum_variance = Sigma().cwiseAbs2();
  sum_variance[6] += lag_sigma * lag_sigma;
  const RigMatrix prior = sum_variance.cwiseInverse().asDiagonal();
  const RigMatrix P = (prior + A.transpose() * A).inverse();
  return UpdateRig(Sigma(), lag_sigma, P * A.transpose() * (A * truth), P);
}

TEST(RigPriorSigma, IsWhatTheRigFileStatesOrTheDefault) {
  Rig rig;
  rig.T_body_camera_sigma.rotation = {0.01, 0, 0.03};
  const RigVector sigma = RigPriorSigma(rig);
  EXPECT_EQ(sigma[0], 0.01);
  EXPECT_EQ(sigma[3], 0.01);
  EXPECT_EQ(sigma[4], kRadiansPerDegree);
  EXPECT_EQ(sigma[5], 0.03);
  EXPECT_EQ(sigma[6], 0.005);
}

TEST(UpdateRig, AnObservableDirectionMovesToItsTrueValueAndAnUnobservableOneIsKept) {
  Eigen::Matrix<double, 1, 7> A = Eigen::Matrix<double, 1, 7>::Zero();
  A(0, 4) = 1 / 0.0005;  // rotation about y, known to 0.5 mrad
  RigVector truth;
  truth << 0.005, -0.01, 0.01, 0.02, -0.03, 0.01, 0.004;
  const RigUpdate update = Update(A, truth);
  EXPECT_TRUE(update.learned_any());
  for (int k = 0; k < 7; ++k) {
    if (k == 4) continue;
    EXPECT_NEAR(update.change[k], 0, 1e-12) << k;
    EXPECT_NEAR(std::sqrt(update.covariance(k, k)), Sigma()[k], 1e-12) << k;
  }
  EXPECT_NEAR(update.change[4], -0.03, 5e-5);  // hardly drawn to the rig file's
  EXPECT_NEAR(std::sqrt(update.covariance(4, 4)), 0.0005, 1e-6);
  EXPECT_NEAR(std::abs(update.directions.back().one_sigma[4]), 0.02, 1e-9);
  EXPECT_TRUE(update.directions.back().moved);
}

TEST(UpdateRig, OnlyTheSumOfTwoValuesIsLearnedWhereOnlyThatIsMeasured) {
  Eigen::Matrix<double, 1, 7> A = Eigen::Matrix<double, 1, 7>::Zero();
  A(0, 3) = A(0, 5) = 1 / 0.0001;
  RigVector truth = RigVector::Zero();
  truth[3] = 0.03;
  const RigUpdate update = Update(A, truth);
  EXPECT_NEAR(update.change[3], 0.015, 1e-5);  // shared evenly
  EXPECT_NEAR(update.change[5], 0.015, 1e-5);
  EXPECT_NEAR(update.covariance(3, 3) + update.covariance(5, 5) + 2 * update.covariance(3, 5), 1e-8, 1e-9);
  EXPECT_NEAR(std::sqrt(update.covariance(3, 3)), 0.02 / std::sqrt(2.0), 1e-5);
}

TEST(UpdateRig, WhatSaysLessThanTheRigFileMovesNothing) {
  Eigen::Matrix<double, 7, 7> A = Eigen::Matrix<double, 7, 7>(Sigma().cwiseInverse().asDiagonal());
  const RigUpdate update = Update(A, 2 * Sigma());
  EXPECT_FALSE(update.learned_any());
  EXPECT_TRUE(update.change.isZero(0));
  EXPECT_TRUE(update.covariance.isApprox(RigMatrix(Sigma().cwiseAbs2().asDiagonal())));
  for (const RigDirection& d : update.directions) EXPECT_NEAR(d.posterior_variance, 0.5, 1e-9);
}

TEST(UpdateRig, AFigureThatMayBeOffByChanceOnlyIsKeptAndKnownTheBetter) {
  Eigen::Matrix<double, 1, 7> A = Eigen::Matrix<double, 1, 7>::Zero();
  A(0, 4) = 1 / 0.002;
  RigVector truth = RigVector::Zero();
  truth[4] = 0.003;  // one and a half sigmas
  const RigUpdate update = Update(A, truth);
  EXPECT_EQ(update.change[4], 0);
  EXPECT_FALSE(update.directions.back().moved);
  EXPECT_TRUE(update.learned_any());
  EXPECT_NEAR(std::sqrt(update.covariance(4, 4)), std::hypot(0.002, 0.003), 1e-4);
  truth[4] = 0.005;
  EXPECT_NEAR(Update(A, truth).change[4], 0.005, 1e-4);
  EXPECT_NEAR(std::sqrt(Update(A, truth).covariance(4, 4)), 0.002, 1e-4);
}

TEST(UpdateRig, AnOffsetIsNotLearnedWhereTheDataMayLagBehindAsMuch) {
  Eigen::Matrix<double, 1, 7> A = Eigen::Matrix<double, 1, 7>::Zero();
  A(0, 6) = 1 / 0.0002;
  RigVector truth = RigVector::Zero();
  truth[6] = 0.008;
  EXPECT_NEAR(Update(A, truth).change[6], 0.008, 1e-4);
  EXPECT_NEAR(Update(A, truth, 0.001).change[6], 0.0077, 1e-4);
  EXPECT_NEAR(std::sqrt(Update(A, truth, 0.001).covariance(6, 6)), 0.001, 1e-4);
  EXPECT_EQ(Update(A, truth, 0.006).change[6], 0);
}

}  // namespace
}  // namespace evit
