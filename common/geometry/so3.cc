#include "common/geometry/so3.h"

#include <cmath>

namespace evit {

Eigen::Matrix3d Hat(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Quaterniond ExpSO3(const Eigen::Vector3d& phi) {
  const double theta2 = phi.squaredNorm();
  double w = 0, k = 0;  // cos(theta/2), sin(theta/2)/theta
  if (theta2 < 1e-8) {  // Taylor series: the next term is below 1e-17
    w = 1.0 - theta2 / 8.0;
    k = 0.5 - theta2 / 48.0;
  } else {
    const double theta = std::sqrt(theta2);
    w = std::cos(0.5 * theta);
    k = std::sin(0.5 * theta) / theta;
  }
  return {w, k * phi.x(), k * phi.y(), k * phi.z()};
}

Eigen::Vector3d LogSO3(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;  // q and -q are one rotation: take the shorter way
  const double n = q.vec().norm(), w = sign * q.w();
  const double k = n < 1e-9 ? 2.0 / w : 2.0 * std::atan2(n, w) / n;
  return sign * k * q.vec();
}

Eigen::Matrix3d RightJacobianSO3(const Eigen::Vector3d& phi) {
  const double theta2 = phi.squaredNorm(), theta = std::sqrt(theta2);
  const Eigen::Matrix3d h = Hat(phi);
  if (theta < 1e-4) {
    return Eigen::Matrix3d::Identity() - 0.5 * h + h * h / 6.0;
  }
  return Eigen::Matrix3d::Identity() - (1 - std::cos(theta)) / theta2 * h +
         (theta - std::sin(theta)) / (theta2 * theta) * h * h;
}

Eigen::Matrix3d RightJacobianInverseSO3(const Eigen::Vector3d& phi) {
  const double theta2 = phi.squaredNorm(), theta = std::sqrt(theta2);
  const Eigen::Matrix3d h = Hat(phi);
  if (theta < 1e-4) {
    return Eigen::Matrix3d::Identity() + 0.5 * h + h * h / 12.0;
  }
  const double half = 0.5 * theta;
  return Eigen::Matrix3d::Identity() + 0.5 * h + (1.0 / theta2 - 0.5 / (theta * std::tan(half))) * h * h;
}

}  // namespace evit
