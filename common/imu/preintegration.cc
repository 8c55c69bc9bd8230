#include "common/imu/preintegration.h"

#include <utility>

namespace evit {
namespace {

// A reading at full scale says only that there was at least so much: the error of such a step, as a share of
// the range.
constexpr double kSaturatedError = 0.3;

bool Saturated(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double range) {
  return a.cwiseAbs().cwiseMax(b.cwiseAbs()).maxCoeff() >= 0.99 * range;
}

// Variance of a step's mean reading: a density becomes one by dividing by dt (Kalibr's convention).
double Variance(double density, double dt, bool saturated, double range) {
  const double error = saturated ? kSaturatedError * range : 0;
  return density * density / dt + error * error;
}

}  // namespace

Preintegration::Preintegration(std::vector<ImuSample> samples, const ImuBias& bias, const ImuNoise& noise)
    : samples_(std::move(samples)), noise_(noise) {
  Repropagate(bias);
}

void Preintegration::Repropagate(const ImuBias& bias) {
  bias_ = bias;
  dt_ = 0;
  delta_ = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()};
  covariance_.setZero();
  d_gyro_bias_.setZero();
  d_accel_bias_.setZero();
  for (std::size_t k = 1; k < samples_.size(); ++k) Integrate(samples_[k - 1], samples_[k]);
}

void Preintegration::Integrate(const ImuSample& a, const ImuSample& b) {
  const double dt = ToSeconds(b.t - a.t), half_dt2 = 0.5 * dt * dt;
  const Eigen::Vector3d rate = 0.5 * (a.gyro + b.gyro) - bias_.gyro;
  const Eigen::Vector3d accel_a = a.accel - bias_.accel, accel_b = b.accel - bias_.accel;
  const Eigen::Quaterniond turn = ExpSO3(rate * dt);
  const Eigen::Matrix3d dR = turn.toRotationMatrix(), Jr = RightJacobianSO3(rate * dt);
  const Eigen::Matrix3d R_a = delta_.gamma.toRotationMatrix(), R_b = R_a * dR;
  const Eigen::Vector3d accel = 0.5 * (R_a * accel_a + R_b * accel_b);  // mean over the step, frame of body i

  delta_.alpha += dt * delta_.beta + half_dt2 * accel;
  delta_.beta += dt * accel;
  delta_.gamma = (delta_.gamma * turn).normalized();

  // Error state (alpha, beta, gamma): x' = F x + G_gyro n_gyro + G_accel n_accel, derivatives of the three
  // lines above.
  const Eigen::Matrix3d accel_by_gamma = -0.5 * (R_a * Hat(accel_a) + R_b * Hat(accel_b) * dR.transpose());
  const Eigen::Matrix3d accel_by_rate = -0.5 * dt * R_b * Hat(accel_b) * Jr;
  const Eigen::Matrix3d accel_by_accel = 0.5 * (R_a + R_b);
  Matrix9d F = Matrix9d::Identity();
  F.block<3, 3>(0, 3) = dt * Eigen::Matrix3d::Identity();
  F.block<3, 3>(0, 6) = half_dt2 * accel_by_gamma;
  F.block<3, 3>(3, 6) = dt * accel_by_gamma;
  F.block<3, 3>(6, 6) = dR.transpose();
  Matrix93d G_gyro, G_accel;
  G_gyro << half_dt2 * accel_by_rate, dt * accel_by_rate, dt * Jr;
  G_accel << half_dt2 * accel_by_accel, dt * accel_by_accel, Eigen::Matrix3d::Zero();

  const double gyro_variance =
      Variance(noise_.gyro_density, dt, Saturated(a.gyro, b.gyro, noise_.gyro_range), noise_.gyro_range);
  const double accel_variance =
      Variance(noise_.accel_density, dt, Saturated(a.accel, b.accel, noise_.accel_range), noise_.accel_range);
  covariance_ = (F * covariance_ * F.transpose() + gyro_variance * G_gyro * G_gyro.transpose() +
                 accel_variance * G_accel * G_accel.transpose())
                    .eval();
  d_gyro_bias_ = (F * d_gyro_bias_ - G_gyro).eval();
  d_accel_bias_ = (F * d_accel_bias_ - G_accel).eval();
  dt_ += dt;
}

Preintegration::Delta Preintegration::Corrected(const ImuBias& bias) const {
  const Eigen::Matrix<double, 9, 1> d =
      d_gyro_bias_ * (bias.gyro - bias_.gyro) + d_accel_bias_ * (bias.accel - bias_.accel);
  return {delta_.alpha + d.head<3>(), delta_.beta + d.segment<3>(3),
          (delta_.gamma * ExpSO3(d.tail<3>())).normalized()};
}

bool Preintegration::NeedsRepropagation(const ImuBias& bias) const {
  return (bias.gyro - bias_.gyro).norm() > 0.01 || (bias.accel - bias_.accel).norm() > 0.1;
}

}  // namespace evit
