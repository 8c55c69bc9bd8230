#include "common/tracking/imu_term.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace evit {

ImuTerm::ImuTerm(const Preintegration* pre, double gravity, double noise_factor)
    : pre_(pre), gravity_(gravity) {
  using Matrix9d = Preintegration::Matrix9d;
  // A floor of 1 um, 1 um/s, 1 urad keeps the inverse finite for two coinciding samples or a noise-free IMU.
  const Matrix9d covariance = noise_factor * noise_factor * pre->covariance() + 1e-12 * Matrix9d::Identity();
  // With covariance = L L^T the whitening matrix is L^-1.
  sqrt_information_ = covariance.llt().matrixL().solve(Matrix9d::Identity());
  const double root_dt = std::sqrt(std::max(pre->dt(), 1e-6));
  const auto weight = [&](double walk) { return 1.0 / std::max(noise_factor * walk * root_dt, 1e-9); };
  gyro_bias_weight_ = weight(pre->noise().gyro_random_walk);
  accel_bias_weight_ = weight(pre->noise().accel_random_walk);
}

Vector15d ImuTerm::Evaluate(const BodyState& i, const BodyState& j, Matrix15d* jacobian_i,
                            Matrix15d* jacobian_j) const {
  const double dt = pre_->dt();
  const Preintegration::Delta delta = pre_->Corrected(i.bias);
  const Eigen::Vector3d gravity(0, 0, gravity_);
  const Eigen::Matrix3d Rt_i = i.T_map_body.R().transpose();
  const Eigen::Vector3d alpha =
      Rt_i * (j.T_map_body.p - i.T_map_body.p + 0.5 * dt * dt * gravity - dt * i.velocity);
  const Eigen::Vector3d beta = Rt_i * (j.velocity - i.velocity + dt * gravity);
  const Eigen::Quaterniond q_ij = i.T_map_body.q.conjugate() * j.T_map_body.q;
  const Eigen::Vector3d gamma = LogSO3(delta.gamma.conjugate() * q_ij);

  Vector15d r;
  r.head<9>() << alpha - delta.alpha, beta - delta.beta, gamma;
  r.head<9>() = (sqrt_information_ * r.head<9>()).eval();
  r.segment<3>(9) = gyro_bias_weight_ * (j.bias.gyro - i.bias.gyro);
  r.segment<3>(12) = accel_bias_weight_ * (j.bias.accel - i.bias.accel);

  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  if (jacobian_i != nullptr) {
    const Eigen::Matrix3d jr_inv = RightJacobianInverseSO3(gamma);
    const Eigen::Vector3d d_bias = pre_->d_gyro_bias().bottomRows<3>() * (i.bias.gyro - pre_->bias().gyro);
    Eigen::Matrix<double, 9, 15> j9 = Eigen::Matrix<double, 9, 15>::Zero();
    j9.block<3, 3>(0, 0) = -Rt_i;
    j9.block<3, 3>(0, 3) = Hat(alpha);
    j9.block<3, 3>(0, 6) = -dt * Rt_i;
    j9.block<3, 3>(3, 3) = Hat(beta);
    j9.block<3, 3>(3, 6) = -Rt_i;
    j9.block<3, 3>(6, 3) = -jr_inv * q_ij.toRotationMatrix().transpose();
    j9.block<6, 3>(0, 9) = -pre_->d_gyro_bias().topRows<6>();
    j9.block<3, 3>(6, 9) = -jr_inv * ExpSO3(-gamma).toRotationMatrix() * RightJacobianSO3(d_bias) *
                           pre_->d_gyro_bias().bottomRows<3>();
    j9.block<6, 3>(0, 12) = -pre_->d_accel_bias().topRows<6>();
    jacobian_i->setZero();
    jacobian_i->topRows<9>().noalias() = sqrt_information_ * j9;
    jacobian_i->block<3, 3>(9, 9) = -gyro_bias_weight_ * I;
    jacobian_i->block<3, 3>(12, 12) = -accel_bias_weight_ * I;
  }
  if (jacobian_j != nullptr) {
    Eigen::Matrix<double, 9, 15> j9 = Eigen::Matrix<double, 9, 15>::Zero();
    j9.block<3, 3>(0, 0) = Rt_i;
    j9.block<3, 3>(3, 6) = Rt_i;
    j9.block<3, 3>(6, 3) = RightJacobianInverseSO3(gamma);
    jacobian_j->setZero();
    jacobian_j->topRows<9>().noalias() = sqrt_information_ * j9;
    jacobian_j->block<3, 3>(9, 9) = gyro_bias_weight_ * I;
    jacobian_j->block<3, 3>(12, 12) = accel_bias_weight_ * I;
  }
  return r;
}

}  // namespace evit
