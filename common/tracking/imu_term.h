#pragma once

#include <Eigen/Core>

#include "common/imu/preintegration.h"
#include "common/tracking/state.h"

namespace evit {

/// The IMU term between two keyframes i and j (paper Eq. (4)), whitened. Rows: alpha, beta, gamma, gyro bias,
/// accel bias. The rotation row is Log(gamma^T R_i^T R_j). The paper's, twice the vector part of Q_i^-1 Q_j
/// gamma^-1, is the same vector turned by gamma, for small errors; this one stays right for large ones too.
class ImuTerm {
 public:
  /// `pre` must outlive this. `noise_factor` multiplies the calibrated densities the covariance was made
  /// with.
  ImuTerm(const Preintegration* pre, double gravity, double noise_factor);

  /// Residual, and where not null its Jacobians over the tangents of i and j.
  Vector15d Evaluate(const BodyState& i, const BodyState& j, Matrix15d* jacobian_i,
                     Matrix15d* jacobian_j) const;

 private:
  const Preintegration* pre_;
  double gravity_;
  Eigen::Matrix<double, 9, 9> sqrt_information_;
  double gyro_bias_weight_, accel_bias_weight_;
};

}  // namespace evit
