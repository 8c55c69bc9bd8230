#pragma once

#include "common/geometry/so3.h"

namespace evit {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Rigid transformation. A variable `T_a_b` maps coordinates of frame b to frame a: p_a = T_a_b * p_b.
/// Perturbation everywhere in this project: position in the outer frame, rotation on the right,
/// p <- p + dp, q <- q * ExpSO3(dtheta); a tangent vector is (dp [m], dtheta [rad]).
struct SE3 {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();

  SE3() = default;
  SE3(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& position) : q(rotation), p(position) {}
  explicit SE3(const Eigen::Matrix4d& m)
      : q(Eigen::Quaterniond(Eigen::Matrix3d(m.topLeftCorner<3, 3>())).normalized()),
        p(m.topRightCorner<3, 1>()) {}

  SE3 operator*(const SE3& b) const { return {(q * b.q).normalized(), q * b.p + p}; }
  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const { return q * x + p; }
  SE3 Inverse() const { return {q.conjugate(), q.conjugate() * -p}; }
  Eigen::Matrix3d R() const { return q.toRotationMatrix(); }

  /// This pose moved by a tangent vector (dp, dtheta).
  SE3 Plus(const Eigen::Matrix<double, 6, 1>& d) const {
    return {(q * ExpSO3(d.tail<3>())).normalized(), p + d.head<3>()};
  }
};

/// Between a (s=0) and b (s=1): position on the line, rotation on the geodesic.
inline SE3 Interpolate(const SE3& a, const SE3& b, double s) {
  return {a.q.slerp(s, b.q), a.p + s * (b.p - a.p)};
}

/// Angle between two rotations, rad, 0..pi.
inline double AngularDistance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return LogSO3(a.conjugate() * b).norm();
}

}  // namespace evit
