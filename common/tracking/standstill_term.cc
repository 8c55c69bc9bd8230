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
constexpr double kForce = 0.01;   // m/s^2: noise of a mean over a quarter of a second, and scale

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

bool MayStandStill(const BodyState& state, const Matrix15d& information, const ImuSample& reading,
                   double gravity) {
  // Refuse one standstill in a hundred each: 6 and 3 degrees of freedom.
  constexpr double kChi2Motion = 16.8, kChi2Force = 11.3;
  const Matrix15d covariance = WindowStateCovariance(information);
  Vector6d moved;
  moved << state.velocity, reading.gyro - state.bias.gyro;
  Matrix6d of_moved = covariance.block<6, 6>(6, 6);
  of_moved.diagonal().head<3>().array() += kSpeed * kSpeed;
  of_moved.diagonal().tail<3>().array() += kRate * kRate;
  if (moved.dot(of_moved.ldlt().solve(moved)) > kChi2Motion) return false;

  const Eigen::Vector3d up = state.T_map_body.q.conjugate() * Eigen::Vector3d(0, 0, gravity);
  const Eigen::Vector3d force = reading.accel - up - state.bias.accel;
  Eigen::Matrix<double, 3, 15> J = Eigen::Matrix<double, 3, 15>::Zero();  // of the force
  J.block<3, 3>(0, 3) = -Hat(up);
  J.block<3, 3>(0, 12) = -Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d of_force =
      J * covariance * J.transpose() + kForce * kForce * Eigen::Matrix3d::Identity();
  return force.dot(of_force.ldlt().solve(force)) <= kChi2Force;
}

}  // namespace evit
