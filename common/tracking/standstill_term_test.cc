#include "common/tracking/standstill_term.h"

#include <gtest/gtest.h>

#include <vector>

#include "common/tracking/keyframe_link.h"

namespace evit {
namespace {

BodyState Somewhere() {
  BodyState state;
  state.T_map_body = {ExpSO3({0.5, 1.0, -0.7}), {3, 2, 1}};
  state.velocity = {0.1, -0.2, 0.3};
  return state;
}

TEST(StandstillTerm, JacobiansMatchNumericDerivatives) {
  const StandstillTerm term(0.1);
  const BodyState i = Somewhere(), j = Plus(i, 0.3 * Vector15d::Ones());
  StandstillTerm::Jacobian Ji, Jj, unused_i, unused_j;
  term.Evaluate(i, j, &Ji, &Jj);
  const auto value = [&](const BodyState& a, const BodyState& b) {
    return term.Evaluate(a, b, &unused_i, &unused_j);
  };
  for (int k = 0; k < 15; ++k) {
    constexpr double kStep = 1e-6;
    const Vector15d d = kStep * Vector15d::Unit(k);
    const StandstillTerm::Vector9d di = (value(Plus(i, d), j) - value(Plus(i, -d), j)) / (2 * kStep);
    const StandstillTerm::Vector9d dj = (value(i, Plus(j, d)) - value(i, Plus(j, -d))) / (2 * kStep);
    EXPECT_LT((di - Ji.col(k)).norm(), 1e-6 * Ji.norm()) << "i, column " << k;
    EXPECT_LT((dj - Jj.col(k)).norm(), 1e-6 * Jj.norm()) << "j, column " << k;
  }
}

TEST(StandstillTerm, VanishesForABodyThatStandsStill) {
  BodyState state = Somewhere();
  state.velocity.setZero();
  StandstillTerm::Jacobian Ji, Jj;
  EXPECT_EQ(StandstillTerm(0.1).Evaluate(state, state, &Ji, &Jj).norm(), 0);
}

// Its rows add to the IMU's.
TEST(KeyframeLink, AddsTheStandstillToTheImu) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero(), gravity(0, 0, 9.81);
  const std::vector<ImuSample> samples{{0, zero, gravity}, {5'000, zero, gravity}, {10'000, zero, gravity}};
  const Preintegration pre(samples, {}, {7e-4, 1.3e-3, 7e-6, 6e-5});
  const ImuTerm imu(&pre, 9.81, 1);
  const StandstillTerm still(pre.dt());
  const BodyState i, j = Plus(i, 1e-4 * Vector15d::Ones());
  Matrix15d Ji, Jj;
  const Vector15d r = imu.Evaluate(i, j, &Ji, &Jj);
  StandstillTerm::Jacobian Si, Sj;
  const StandstillTerm::Vector9d s = still.Evaluate(i, j, &Si, &Sj);
  const KeyframeLink::Term term = KeyframeLink(imu, still).Evaluate(i, j);
  EXPECT_DOUBLE_EQ(term.cost, 0.5 * r.squaredNorm() + 0.5 * s.squaredNorm());
  EXPECT_TRUE(term.gradient_i.isApprox(Ji.transpose() * r + Si.transpose() * s));
  EXPECT_TRUE(term.gradient_j.isApprox(Jj.transpose() * r + Sj.transpose() * s));
  EXPECT_TRUE(term.hessian_ii.isApprox(Ji.transpose() * Ji + Si.transpose() * Si));
  EXPECT_TRUE(term.hessian_ij.isApprox(Ji.transpose() * Jj + Si.transpose() * Sj));
  EXPECT_TRUE(term.hessian_jj.isApprox(Jj.transpose() * Jj + Sj.transpose() * Sj));
}

TEST(MayStandStill, ComparesVelocityAndRateWithWhatIsKnownOfThem) {
  BodyState state;
  state.bias.gyro = {0.01, 0, 0};
  Matrix15d information = Matrix15d::Identity();
  information.diagonal().segment<3>(6).setConstant(5 / (0.02 * 0.02));    // 2 cm/s, five keyframes as one
  information.diagonal().segment<3>(9).setConstant(5 / (0.003 * 0.003));  // rad/s
  EXPECT_TRUE(MayStandStill(state, information, {0.015, 0, 0}));
  EXPECT_FALSE(MayStandStill(state, information, {0.03, 0, 0}));
  state.velocity.x() = 0.05;
  EXPECT_TRUE(MayStandStill(state, information, state.bias.gyro));
  state.velocity.x() = 0.1;
  EXPECT_FALSE(MayStandStill(state, information, state.bias.gyro));
}

}  // namespace
}  // namespace evit
