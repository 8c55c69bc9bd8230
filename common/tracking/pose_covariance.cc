#include "common/tracking/pose_covariance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "common/geometry/so3.h"
#include "common/tracking/state_matrices.h"

namespace evit {

namespace {

// So many keyframes of a window say what one independent one would. The IMU alone carried states of ten runs
// on recordings and of three in simulation on for a second: with 1 here their positions were off by three
// times the variance of all terms (geometric mean; up to eight times), with 5 by 0.7 times
// (docs/results/trials.md).
constexpr double kAsOne = 5;

Matrix15d Covariance(const Matrix15d& information) {
  const Matrix15d ridge = 1e-9 * Matrix15d(information.diagonal().cwiseMax(1e-9).asDiagonal());
  return Solve(Matrix15d(information + ridge), Matrix15d(Matrix15d::Identity()));
}

}  // namespace

Matrix6d PoseCovariance(const Matrix15d& information) {
  const Matrix15d covariance = Covariance(information);
  return 0.5 * (covariance.topLeftCorner<6, 6>() + covariance.topLeftCorner<6, 6>().transpose());
}

Matrix6d SystematicCovariance(const Matrix6d& alignment, double share, double map_sigma) {
  Matrix6d common = Matrix6d::Zero();
  if (share > 0) {
    // Where a keyframe says nothing of a direction the map cannot pull the pose along it either.
    constexpr double kMostPosition = 0.03, kMostRotation = 0.02;  // m, rad
    Matrix6d information = alignment / share;
    information.diagonal().head<3>().array() += 1 / (kMostPosition * kMostPosition);
    information.diagonal().tail<3>().array() += 1 / (kMostRotation * kMostRotation);
    common = information.ldlt().solve(Matrix6d::Identity());
    common = (0.5 * (common + common.transpose())).eval();
  }
  common.diagonal().head<3>().array() += map_sigma * map_sigma;
  return common;
}

Matrix6d MisfitCovariance(const AlignmentMisfit& misfit, double share, double focal_px) {
  // No event tells where within its pixel an edge lies: up to half a pixel either way, a quarter in the
  // median.
  constexpr double kGrid = 0.25;
  const double variance_px =
      share * share * std::max(0.0, misfit.offset_px * misfit.offset_px - kGrid * kGrid);
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal().head<3>().setConstant(variance_px * misfit.metres_per_px * misfit.metres_per_px);
  covariance.diagonal().tail<3>().setConstant(variance_px / (focal_px * focal_px));
  return covariance;
}

Matrix6d TimeOffsetCovariance(const Eigen::Vector3d& velocity, const Eigen::Vector3d& rate, double sigma) {
  Vector6d moved;
  moved << sigma * velocity, sigma * rate;
  return moved * moved.transpose();
}

// With T_map_camera fixed, T_body_camera = (R Exp(φ), p + δ) puts the body at
//   R_map_body Exp(-R φ),   p_map_camera - R_map_body Exp(-R φ) (p + δ),
// to first order p_map_body - R_map_body (δ + p x R φ).
Matrix6d ExtrinsicsCovariance(const SE3& T_map_body, const Rig& rig) {
  const Eigen::Matrix3d R_map_body = T_map_body.R(), R_body_camera = rig.T_body_camera.R();
  Matrix6d J = Matrix6d::Zero();  // by δ (m, body frame) and φ (rad, camera frame)
  J.topLeftCorner<3, 3>() = -R_map_body;
  J.topRightCorner<3, 3>() = -R_map_body * Hat(rig.T_body_camera.p) * R_body_camera;
  J.bottomRightCorner<3, 3>() = -R_body_camera;
  Vector6d sigma;
  sigma << rig.T_body_camera_sigma.translation, rig.T_body_camera_sigma.rotation;
  return J * sigma.cwiseAbs2().asDiagonal() * J.transpose();
}

Matrix6d WindowCovariance(const Matrix15d& information) { return kAsOne * PoseCovariance(information); }

Matrix6d MotionCovariance(const Matrix15d& information) {
  return kAsOne * Covariance(information).block<6, 6>(6, 6);
}

void PoseUncertainty::SetAlignment(const Matrix6d& alignment, const AlignmentMisfit& misfit) {
  constexpr int kMisfits = 10;     // keyframes: a quarter to half a second
  constexpr int kFewPatches = 10;  // of fewer the median means nothing
  if (misfit.n_patches >= kFewPatches) {
    n_misfits_ = std::min(n_misfits_ + 1, kMisfits);
    misfit_.offset_px += (misfit.offset_px - misfit_.offset_px) / n_misfits_;
    misfit_.metres_per_px += (misfit.metres_per_px - misfit_.metres_per_px) / n_misfits_;
  }
  systematic_ = SystematicCovariance(alignment, options_.correlated_share, options_.map_sigma_m) +
                MisfitCovariance(misfit_, options_.misfit_share, focal_px_);
}

Matrix6d PoseUncertainty::Covariance(const Matrix6d& random, const Eigen::Vector3d& velocity,
                                     const Eigen::Vector3d& rate) const {
  return random + Systematic(velocity, rate);
}

Matrix6d PoseUncertainty::Systematic(const Eigen::Vector3d& velocity, const Eigen::Vector3d& rate) const {
  return systematic_ + TimeOffsetCovariance(velocity, rate, 1e-6 * options_.stamp_sigma_us);
}

}  // namespace evit
