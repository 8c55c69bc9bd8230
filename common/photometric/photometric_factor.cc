#include "common/photometric/photometric_factor.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "common/tracking/pose_manifold.h"

namespace evit {

bool PhotometricFactor::Evaluate(double const* const* parameters, double* residuals,
                                 double** jacobians) const {
  const bool derivatives = jacobians != nullptr && (jacobians[0] != nullptr || jacobians[1] != nullptr);
  const PhotometricTerm term = EvaluatePhotometric(*scene_, PoseFromBlock(parameters[0]),
                                                   Eigen::Map<const Twist>(parameters[1]), derivatives);
  Eigen::Map<Eigen::Matrix<double, 13, 1>> r(residuals);
  r.setZero();
  if (!derivatives) {
    r[12] = std::sqrt(2 * term.cost);
    return std::isfinite(r[12]);
  }
  // Eigenvectors rather than Cholesky: the size of the twist costs nothing, so H never has full rank.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 12, 12>> solver(term.hessian);
  const Eigen::Matrix<double, 12, 1> root = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  const Eigen::Matrix<double, 12, 12> J = root.asDiagonal() * solver.eigenvectors().transpose();
  const Eigen::Matrix<double, 12, 1> g = solver.eigenvectors().transpose() * term.gradient;
  // Roots of eigenvalues that are nothing but the rounding of sums in single precision.
  const double floor = 3e-4 * root.maxCoeff();
  for (int k = 0; k < 12; ++k) r[k] = root[k] > floor ? g[k] / root[k] : 0.0;
  r[12] = std::sqrt(std::max(0.0, 2 * term.cost - r.head<12>().squaredNorm()));
  if (jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 13, 7, Eigen::RowMajor>> out(jacobians[0]);
    out.setZero();
    out.topLeftCorner<12, 6>() = J.leftCols<6>();
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 13, 6, Eigen::RowMajor>> out(jacobians[1]);
    out.setZero();
    out.topRows<12>() = J.rightCols<6>();
  }
  return r.allFinite() && J.allFinite();
}

bool MotionPriorFactor::Evaluate(double const* const* parameters, double* residuals,
                                 double** jacobians) const {
  const SE3 pose = PoseFromBlock(parameters[0]);
  const Eigen::Vector3d turn = LogSO3(pose_.q.conjugate() * pose.q.normalized());
  Eigen::Map<Eigen::Matrix<double, 12, 1>> r(residuals);
  r.head<3>() = pose_weight_.head<3>().cwiseProduct(pose.p - pose_.p);
  r.segment<3>(3) = pose_weight_.tail<3>().cwiseProduct(turn);
  r.tail<6>() = twist_weight_.cwiseProduct(Eigen::Map<const Twist>(parameters[1]) - twist_);
  if (jacobians == nullptr) return r.allFinite();
  if (jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 12, 7, Eigen::RowMajor>> out(jacobians[0]);
    out.setZero();
    out.topLeftCorner<3, 3>() = pose_weight_.head<3>().asDiagonal();
    out.block<3, 3>(3, 3) = pose_weight_.tail<3>().asDiagonal() * RightJacobianInverseSO3(turn);
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 12, 6, Eigen::RowMajor>> out(jacobians[1]);
    out.setZero();
    out.bottomRows<6>() = twist_weight_.asDiagonal();
  }
  return r.allFinite();
}

}  // namespace evit
