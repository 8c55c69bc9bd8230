#include "common/geometry/se3.h"

namespace evit {

SE3::SE3(const Eigen::Matrix4d& m)
    : q(Eigen::Quaterniond(Eigen::Matrix3d(m.topLeftCorner<3, 3>())).normalized()),
      p(m.topRightCorner<3, 1>()) {}

SE3 SE3::operator*(const SE3& b) const { return {(q * b.q).normalized(), q * b.p + p}; }

Eigen::Vector3d SE3::operator*(const Eigen::Vector3d& x) const { return q * x + p; }

SE3 SE3::Inverse() const { return {q.conjugate(), q.conjugate() * -p}; }

Eigen::Matrix3d SE3::R() const { return q.toRotationMatrix(); }

SE3 SE3::Plus(const Vector6d& d) const { return {(q * ExpSO3(d.tail<3>())).normalized(), p + d.head<3>()}; }

SE3 Interpolate(const SE3& a, const SE3& b, double s) { return {a.q.slerp(s, b.q), a.p + s * (b.p - a.p)}; }

double AngularDistance(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return LogSO3(a.conjugate() * b).norm();
}

}  // namespace evit
