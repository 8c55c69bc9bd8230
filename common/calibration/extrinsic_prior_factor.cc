#include "common/calibration/extrinsic_prior_factor.h"

#include <Eigen/Cholesky>

#include "common/tracking/state.h"

namespace evit {

ExtrinsicPriorFactor::ExtrinsicPriorFactor(const SE3& T_body_camera,
                                           const Eigen::Matrix3d& position_information,
                                           const Eigen::Matrix3d& rotation_information)
    : mean_(T_body_camera),
      root_p_(position_information.llt().matrixU()),
      root_r_(rotation_information.llt().matrixU()) {}

bool ExtrinsicPriorFactor::Evaluate(double const* const* parameters, double* residuals,
                                    double** jacobians) const {
  const SE3 at = PoseFromBlock(parameters[0]);
  const Eigen::Vector3d turn = LogSO3(mean_.q.conjugate() * at.q);
  Eigen::Map<Eigen::Matrix<double, 6, 1>> r(residuals);
  r << root_p_ * (at.p - mean_.p), root_r_ * turn;
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> J(jacobians[0]);
    J.setZero();
    J.topLeftCorner<3, 3>() = root_p_;
    J.block<3, 3>(3, 3) = root_r_ * RightJacobianInverseSO3(turn);
  }
  return r.allFinite();
}

}  // namespace evit
