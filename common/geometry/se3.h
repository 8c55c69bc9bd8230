#pragma once

#include "common/geometry/so3.h"

namespace evit {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Rigid transformation. A variable `T_a_b` maps coordinates of frame b to frame a: p_a = T_a_b * p_b.
/// Perturbation everywhere in this project: position in the outer frame, rotation on the right,
/// p <- p + dp, q <- q * ExpSO3(dtheta); a tangent vector is (dp [m], dtheta [rad]).
/// Nothing of it is inline: almost every file includes this, and Eigen's templates would be expanded in each.
struct SE3 {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();

  SE3() = default;
  SE3(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& position) : q(rotation), p(position) {}
  explicit SE3(const Eigen::Matrix4d& m);

  SE3 operator*(const SE3& b) const;
  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const;
  SE3 Inverse() const;
  Eigen::Matrix3d R() const;

  /// This pose moved by a tangent vector (dp, dtheta).
  SE3 Plus(const Vector6d& d) const;
};

/// Between a (s=0) and b (s=1): position on the line, rotation on the geodesic.
SE3 Interpolate(const SE3& a, const SE3& b, double s);

/// Angle between two rotations, rad, 0..pi.
double AngularDistance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

}  // namespace evit
