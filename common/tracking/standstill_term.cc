#include "common/tracking/standstill_term.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "common/tracking/pose_covariance.h"

namespace evit {
namespace {

// 1-sigma, of motion that a steady IMU does not show: over a second a walk of 0.6 mm and 0.3 mrad in steps of
// 100 ms, over an hour of 4 cm and 1 degree.
constexpr double kSpeed = 0.002;  // m/s
constexpr double kRate = 0.001;   // rad/s

}  // namespace

StandstillTerm::StandstillTerm(double seconds) {
  const double dt = std::max(seconds, 1e-3);
  position_weight_ = 1 / (kSpeed * dt);
  rotation_weight_ = 1 / (kRate * dt);
}

StandstillTerm::Vector9d StandstillTerm::Evaluate(const BodyState& i, const BodyState& j,
                                                  Jacobian* jacobian_i, Jacobian* jacobian_j) const {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d turned = LogSO3(i.T_map_body.q.conjugate() * j.T_map_body.q);
  Vector9d r;
  r << position_weight_ * (j.T_map_body.p - i.T_map_body.p), rotation_weight_ * turned, j.velocity / kSpeed;
  jacobian_i->setZero();
  jacobian_i->block<3, 3>(0, 0) = -position_weight_ * I;
  jacobian_i->block<3, 3>(3, 3) = -rotation_weight_ * RightJacobianInverseSO3(-turned);
  jacobian_j->setZero();
  jacobian_j->block<3, 3>(0, 0) = position_weight_ * I;
  jacobian_j->block<3, 3>(3, 3) = rotation_weight_ * RightJacobianInverseSO3(turned);
  jacobian_j->block<3, 3>(6, 6) = I / kSpeed;
  return r;
}

bool MayStandStill(const BodyState& state, const Matrix15d& information, const Eigen::Vector3d& steady_rate) {
  constexpr double kChi2 = 16.8;  // 6 degrees of freedom: refuses one standstill in a hundred
  Vector6d moved;
  moved << state.velocity, steady_rate - state.bias.gyro;
  Matrix6d covariance = MotionCovariance(information);
  // What the covariance does not know: errors of the map that the pose passes through, 3 mm in 0.3 s; noise
  // of the mean rate.
  constexpr double kSpeedError = 0.01, kRateError = 0.003;  // m/s, rad/s
  covariance.diagonal().head<3>().array() += kSpeedError * kSpeedError;
  covariance.diagonal().tail<3>().array() += kRateError * kRateError;
  return moved.dot(covariance.ldlt().solve(moved)) <= kChi2;
}

}  // namespace evit
