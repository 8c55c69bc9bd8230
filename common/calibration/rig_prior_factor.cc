#include "common/calibration/rig_prior_factor.h"

#include <Eigen/Cholesky>

#include "common/tracking/state.h"

namespace evit {

RigPriorFactor::RigPriorFactor(const SE3& T_body_camera, double late, const RigMatrix& information)
    : mean_(T_body_camera), late_(late), root_(information.llt().matrixU()) {}

bool RigPriorFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const SE3 at = PoseFromBlock(parameters[0]);
  const Eigen::Vector3d turn = LogSO3(mean_.q.conjugate() * at.q);
  RigVector moved;
  moved << at.p - mean_.p, turn, *parameters[1] - late_;
  Eigen::Map<RigVector> r(residuals);
  r = root_ * moved;
  if (jacobians == nullptr) return r.allFinite();
  if (jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 7, 7, Eigen::RowMajor>> J(jacobians[0]);
    J.setZero();
    J.leftCols<3>() = root_.leftCols<3>();
    J.middleCols<3>(3) = root_.middleCols<3>(3) * RightJacobianInverseSO3(turn);
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<RigVector> J(jacobians[1]);
    J = root_.col(6);
  }
  return r.allFinite();
}

}  // namespace evit
