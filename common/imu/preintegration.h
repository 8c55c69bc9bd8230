#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "common/geometry/rig.h"
#include "common/imu/imu_sample.h"

namespace evit {

/// IMU samples between two instants i and j, integrated in the body frame of i (paper Sec. III-B.3),
/// independent of the state at i but for the biases. Error state (alpha [m], beta [m/s], gamma [rad, right
/// perturbation]).
///
/// Midpoint integration, not first order: over 30 ms of fast hand-held motion at 200 Hz the first-order rule
/// errs 200 times as much (preintegration_test), far above the sensor noise, at the same cost.
class Preintegration {
 public:
  using Matrix9d = Eigen::Matrix<double, 9, 9>;
  using Matrix93d = Eigen::Matrix<double, 9, 3>;

  Preintegration() = default;
  /// `samples`: strictly increasing times, both boundaries included (at least two samples).
  Preintegration(std::vector<ImuSample> samples, const ImuBias& bias, const ImuNoise& noise);

  /// Integrates the same samples again with another bias (for bias changes too large for the first-order
  /// correction).
  void Repropagate(const ImuBias& bias);

  /// Terms corrected to first order for a bias other than the one integrated with.
  struct Delta {
    Eigen::Vector3d alpha;     // m
    Eigen::Vector3d beta;      // m/s
    Eigen::Quaterniond gamma;  // body j to body i
  };
  Delta Corrected(const ImuBias& bias) const;

  /// True where `bias` is so far from the one integrated with that Repropagate pays (gyro 0.01 rad/s, accel
  /// 0.1 m/s^2).
  bool NeedsRepropagation(const ImuBias& bias) const;

  double dt() const { return dt_; }  // s
  const ImuBias& bias() const { return bias_; }
  const Delta& delta() const { return delta_; }
  const Matrix9d& covariance() const { return covariance_; }
  const Matrix93d& d_gyro_bias() const { return d_gyro_bias_; }
  const Matrix93d& d_accel_bias() const { return d_accel_bias_; }
  const std::vector<ImuSample>& samples() const { return samples_; }
  const ImuNoise& noise() const { return noise_; }

 private:
  void Integrate(const ImuSample& a, const ImuSample& b);

  std::vector<ImuSample> samples_;
  ImuBias bias_;
  ImuNoise noise_;
  double dt_ = 0;
  Delta delta_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()};
  Matrix9d covariance_ = Matrix9d::Zero();
  Matrix93d d_gyro_bias_ = Matrix93d::Zero(), d_accel_bias_ = Matrix93d::Zero();
};

}  // namespace evit
