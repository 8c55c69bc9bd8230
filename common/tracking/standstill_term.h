#pragma once

#include <Eigen/Core>

#include "common/imu/imu_sample.h"
#include "common/tracking/state.h"

namespace evit {

/// Says of two keyframes i and j that the body stood still between them. Rows, whitened: position (map),
/// orientation (Log(R_i^T R_j)), velocity of j. It leaves out the biases: the IMU's term takes them from the
/// pose that stays.
class StandstillTerm {
 public:
  using Vector9d = Eigen::Matrix<double, 9, 1>;
  using Jacobian = Eigen::Matrix<double, 9, 15>;

  /// `seconds`: from i to j.
  explicit StandstillTerm(double seconds);

  /// Residual, and its Jacobians over the tangents of i and j.
  Vector9d Evaluate(const BodyState& i, const BodyState& j, Jacobian* jacobian_i, Jacobian* jacobian_j) const;

 private:
  double position_weight_, rotation_weight_;
};

/// Whether a body whose IMU is steady (`reading`: its mean, biases included; see Steadiness) may stand still,
/// as far as its state is known (`information`): velocity, rate less the gyro's bias, and specific force less
/// gravity (`gravity`, m/s^2 along the map's z) and the accelerometer's bias must be zero. A steady IMU alone
/// does not tell a standstill from even motion, or from a gentle start.
bool MayStandStill(const BodyState& state, const Matrix15d& information, const ImuSample& reading,
                   double gravity);

}  // namespace evit
