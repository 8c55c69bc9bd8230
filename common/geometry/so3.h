#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Rotations SO(3): exponential map and the Jacobians of a right perturbation, R <- R * ExpSO3(delta).
/// Formulas: Forster et al., "On-Manifold Preintegration", 2017, Sec. III-A; Sola, "A micro Lie theory",
/// 2018.
namespace evit {

/// Skew-symmetric matrix: Hat(a) * b == a.cross(b).
Eigen::Matrix3d Hat(const Eigen::Vector3d& v);

/// Rotation vector (rad) to unit quaternion; accurate to machine precision at any angle.
Eigen::Quaterniond ExpSO3(const Eigen::Vector3d& phi);

/// Unit quaternion to rotation vector (rad) of at most pi.
Eigen::Vector3d LogSO3(const Eigen::Quaterniond& q);

/// Right Jacobian Jr: Exp(phi + d) ~= Exp(phi) * Exp(Jr(phi) * d).
Eigen::Matrix3d RightJacobianSO3(const Eigen::Vector3d& phi);

/// Inverse of the right Jacobian: Log(Exp(phi) * Exp(d)) ~= phi + JrInv(phi) * d. For angles below 2 pi.
Eigen::Matrix3d RightJacobianInverseSO3(const Eigen::Vector3d& phi);

}  // namespace evit
