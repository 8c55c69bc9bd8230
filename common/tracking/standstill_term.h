#pragma once

#include <Eigen/Core>

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

/// Whether a body whose IMU is steady (`steady_rate`: mean rate, rad/s, bias included; see Steadiness) may
/// stand still: velocity and rate less bias must be zero as far as they are known (`information` of `state`).
/// A steady IMU alone does not tell a standstill from even motion.
bool MayStandStill(const BodyState& state, const Matrix15d& information, const Eigen::Vector3d& steady_rate);

}  // namespace evit
