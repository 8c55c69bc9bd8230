#include "common/tracking/ceres_factors.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace evit {
namespace {

using PoseJacobian7 = Eigen::Map<Eigen::Matrix<double, 7, 7, Eigen::RowMajor>>;
using PoseJacobian15 = Eigen::Map<Eigen::Matrix<double, 15, 7, Eigen::RowMajor>>;
using MotionJacobian15 = Eigen::Map<Eigen::Matrix<double, 15, 9, Eigen::RowMajor>>;

BodyState StateOf(const double* pose, const double* motion) {
  BodyState s;
  s.T_map_body = PoseFromBlock(pose);
  s.velocity = Eigen::Map<const Eigen::Vector3d>(motion);
  s.bias.gyro = Eigen::Map<const Eigen::Vector3d>(motion + 3);
  s.bias.accel = Eigen::Map<const Eigen::Vector3d>(motion + 6);
  return s;
}

void WriteJacobians(const Matrix15d& j, double* pose, double* motion) {
  if (pose != nullptr) {
    PoseJacobian15 out(pose);
    out.leftCols<6>() = j.leftCols<6>();
    out.col(6).setZero();
  }
  if (motion != nullptr) {
    MotionJacobian15 out(motion);
    out = j.rightCols<9>();
  }
}

}  // namespace

const AlignmentTerm& EventAlignmentFactor::TermAt(const double* pose) const {
  std::array<double, 7> at;
  std::copy_n(pose, at.size(), at.begin());
  if (evaluated_at_ != at) {
    term_ = EvaluateAlignment(*settings_, *field_, level_, *points_, PoseFromBlock(pose), true);
    evaluated_at_ = at;
  }
  return term_;
}

bool EventAlignmentFactor::Evaluate(double const* const* parameters, double* residuals,
                                    double** jacobians) const {
  const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
  const AlignmentTerm& term = TermAt(parameters[0]);
  Eigen::Map<Eigen::Matrix<double, 7, 1>> r(residuals);
  r.setZero();
  if (!derivatives) {
    r[6] = std::sqrt(2 * term.cost);
    return std::isfinite(r[6]);
  }
  // Eigenvectors rather than Cholesky: an empty surface gives H without rank, and that is not an error.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(term.hessian);
  const Eigen::Matrix<double, 6, 1> root = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  PoseJacobian7 J(jacobians[0]);
  J.setZero();
  J.topLeftCorner<6, 6>() = root.asDiagonal() * solver.eigenvectors().transpose();
  const Eigen::Matrix<double, 6, 1> g = solver.eigenvectors().transpose() * term.gradient;
  const double floor = 1e-9 * root.maxCoeff();
  for (int k = 0; k < 6; ++k) r[k] = root[k] > floor ? g[k] / root[k] : 0.0;
  r[6] = std::sqrt(std::max(0.0, 2 * term.cost - r.head<6>().squaredNorm()));
  return r.allFinite() && J.allFinite();
}

bool ImuFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const BodyState i = StateOf(parameters[0], parameters[1]), j = StateOf(parameters[2], parameters[3]);
  Matrix15d Ji, Jj;
  const bool derivatives = jacobians != nullptr;
  Eigen::Map<Vector15d> r(residuals);
  r = term_.Evaluate(i, j, derivatives ? &Ji : nullptr, derivatives ? &Jj : nullptr);
  if (derivatives) {
    WriteJacobians(Ji, jacobians[0], jacobians[1]);
    WriteJacobians(Jj, jacobians[2], jacobians[3]);
  }
  return r.allFinite();
}

bool PriorFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Vector15d d = Minus(StateOf(parameters[0], parameters[1]), mean_);
  Eigen::Map<Vector15d> r(residuals);
  r = root_ * d;
  if (jacobians != nullptr) {
    Matrix15d m = Matrix15d::Identity();
    m.block<3, 3>(3, 3) = RightJacobianInverseSO3(d.segment<3>(3));
    WriteJacobians(root_ * m, jacobians[0], jacobians[1]);
  }
  return r.allFinite();
}

}  // namespace evit
