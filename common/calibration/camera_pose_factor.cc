#include "common/calibration/camera_pose_factor.h"

#include "common/tracking/state.h"

namespace evit {
namespace {

template <int Columns>
using Block = Eigen::Map<Eigen::Matrix<double, 6, Columns, Columns == 1 ? Eigen::ColMajor : Eigen::RowMajor>>;

}  // namespace

bool CameraPoseFactor::Evaluate(double const* const* parameters, double* residuals,
                                double** jacobians) const {
  const SE3 body = PoseFromBlock(parameters[0]), extrinsic = PoseFromBlock(parameters[2]);
  const Eigen::Vector3d velocity = Eigen::Map<const Eigen::Vector3d>(parameters[1]);
  const Eigen::Vector3d rate = gyro_ - Eigen::Map<const Eigen::Vector3d>(parameters[1] + 3);
  const Eigen::Vector3d tilt(parameters[3][0], parameters[3][1], 0);
  const double late = parameters[4][0];

  const Eigen::Quaterniond step = ExpSO3(late * rate), q_map_upright = ExpSO3(tilt);
  const Eigen::Quaterniond q = body.q * step;
  const Eigen::Matrix3d R = q.toRotationMatrix(), R_m = q_map_upright.toRotationMatrix();
  const Eigen::Vector3d camera = body.p + late * velocity + R * extrinsic.p;  // upright frame

  Eigen::Map<Eigen::Matrix<double, 6, 1>> r(residuals);
  r.head<3>() = w_p_ * (R_m * camera - measured_.p);
  const Eigen::Vector3d turn = LogSO3(measured_.q.conjugate() * (q_map_upright * q * extrinsic.q));
  r.tail<3>() = w_r_ * turn;
  if (jacobians == nullptr) return r.allFinite();

  // A turn of the body (right, body frame) and one of the upright frame, in both rows.
  const Eigen::Matrix3d jr_inv = RightJacobianInverseSO3(turn), R_bc = extrinsic.R();
  const Eigen::Matrix3d p_by_body = -w_p_ * R_m * R * Hat(extrinsic.p);
  const Eigen::Matrix3d r_by_body = w_r_ * jr_inv * R_bc.transpose();
  const Eigen::Matrix3d back = step.toRotationMatrix().transpose();
  if (jacobians[0] != nullptr) {
    Block<7> J(jacobians[0]);
    J.setZero();
    J.topLeftCorner<3, 3>() = w_p_ * R_m;
    J.block<3, 3>(0, 3) = p_by_body * back;
    J.block<3, 3>(3, 3) = r_by_body * back;
  }
  if (jacobians[1] != nullptr) {
    Block<9> J(jacobians[1]);
    J.setZero();
    const Eigen::Matrix3d by_bias = -late * RightJacobianSO3(late * rate);
    J.topLeftCorner<3, 3>() = w_p_ * late * R_m;
    J.block<3, 3>(0, 3) = p_by_body * by_bias;
    J.block<3, 3>(3, 3) = r_by_body * by_bias;
  }
  if (jacobians[2] != nullptr) {
    Block<7> J(jacobians[2]);
    J.setZero();
    J.topLeftCorner<3, 3>() = w_p_ * R_m * R;
    J.block<3, 3>(3, 3) = w_r_ * jr_inv;
  }
  if (jacobians[3] != nullptr) {
    Block<2> J(jacobians[3]);
    const Eigen::Matrix<double, 3, 2> by_tilt = RightJacobianSO3(tilt).leftCols<2>();
    J.topRows<3>() = -w_p_ * R_m * Hat(camera) * by_tilt;
    J.bottomRows<3>() = r_by_body * R.transpose() * by_tilt;
  }
  if (jacobians[4] != nullptr) {
    Block<1> J(jacobians[4]);
    J.topRows<3>() = w_p_ * R_m * velocity + p_by_body * rate;
    J.bottomRows<3>() = r_by_body * rate;
  }
  return r.allFinite();
}

}  // namespace evit
