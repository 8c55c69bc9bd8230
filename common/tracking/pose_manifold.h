#pragma once

#include <ceres/manifold.h>

#include "common/tracking/state.h"

namespace evit {

/// (p, q) moved by (dp, dtheta): p + dp, q * Exp(dtheta).
///
/// The cost functions of this project write Jacobians over the tangent directly, into the first six of the
/// seven columns of a pose block; PlusJacobian therefore is (I6; 0), and the seventh column is ignored. This
/// saves the detour through quaternion derivatives, exact for every solver step because Ceres only ever uses
/// their product.
class PoseManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* out) const override {
    const SE3 moved = PoseFromBlock(x).Plus(Eigen::Map<const Eigen::Matrix<double, 6, 1>>(delta));
    Eigen::Map<Eigen::Vector3d>(out + 0) = moved.p;
    Eigen::Map<Eigen::Vector4d>(out + 3) = moved.q.coeffs();
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* out) const override {
    const SE3 a = PoseFromBlock(x), b = PoseFromBlock(y);
    Eigen::Map<Eigen::Vector3d>(out + 0) = b.p - a.p;
    Eigen::Map<Eigen::Vector3d>(out + 3) = LogSO3(a.q.conjugate() * b.q);
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
};

}  // namespace evit
