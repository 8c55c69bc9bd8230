#include "common/calibration/camera_imu_batch.h"

#include <ceres/loss_function.h>
#include <ceres/normal_prior.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "common/calibration/camera_pose_factor.h"
#include "common/calibration/rig_prior_factor.h"
#include "common/tracking/ceres_factors.h"
#include "common/tracking/pose_manifold.h"

namespace evit {
namespace {

constexpr Utime kStill = 20;  // us: an offset that moves less than this stands still
constexpr int kMoves = 6;
constexpr double kCauchy = 4;  // whitened length of six residuals from which a pose counts less

// Covariance of the last 15 of the problem's parameters, in the order of `blocks`: columns of the
// inverse of J' J. (ceres::Covariance would take a QR of the whole chain.)
bool LastCovariance(ceres::Problem* problem, const std::vector<double*>& blocks, CameraImuCovariance* out) {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = blocks;
  options.apply_loss_function = true;
  ceres::CRSMatrix crs;
  if (!problem->Evaluate(options, nullptr, nullptr, nullptr, &crs)) return false;
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> J(
      crs.num_rows, crs.num_cols, static_cast<Eigen::Index>(crs.values.size()), crs.rows.data(),
      crs.cols.data(), crs.values.data());
  const Eigen::SparseMatrix<double> column_major = J;
  const Eigen::SparseMatrix<double> H = column_major.transpose() * column_major;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(H);
  if (ldlt.info() != Eigen::Success) return false;
  constexpr int kLast = CameraImuCovariance::RowsAtCompileTime;
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(H.rows(), kLast);
  unit.bottomRows<kLast>().setIdentity();
  const Eigen::MatrixXd columns = ldlt.solve(unit);
  *out = 0.5 * (columns.bottomRows<kLast>() + columns.bottomRows<kLast>().transpose());
  return out->allFinite();
}

}  // namespace

CameraImuBatch::CameraImuBatch(Trajectory camera, const ImuTrack* imu, const Rig& rig, double noise_factor,
                               const CameraImuValues& start)
    : camera_(std::move(camera)), imu_(imu), rig_(rig), noise_factor_(noise_factor), values_(start) {
  StartStates();
}

void CameraImuBatch::StartStates() {
  const SE3 T_camera_body = values_.T_body_camera.Inverse();
  const SE3 T_upright_map(ExpSO3({-values_.tilt.x(), -values_.tilt.y(), 0}), Eigen::Vector3d::Zero());
  for (const StampedPose& s : camera_) {
    BodyState state;
    state.T_map_body = T_upright_map * s.pose * T_camera_body;
    state.bias = values_.bias;
    states_.push_back(ToBlocks(state));
  }
  // Velocities from poses some 60 ms apart.
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const std::size_t a = k > 3 ? k - 3 : 0, b = std::min(states_.size() - 1, k + 3);
    Eigen::Map<Eigen::Vector3d>(states_[k].motion.data()) =
        (PoseFromBlock(states_[b].pose.data()).p - PoseFromBlock(states_[a].pose.data()).p) /
        ToSeconds(camera_[b].t - camera_[a].t);
  }
}

bool CameraImuBatch::Solve(const CameraImuPrior& prior, const PoseNoise& noise, bool robust) {
  for (int move = 0; move < kMoves; ++move) {
    Utime moved = 0;
    if (!SolveOnce(prior, noise, robust, &moved)) return false;
    if (std::abs(moved) < kStill) return true;
  }
  return true;
}

void CameraImuBatch::AddMeasurements(const PoseNoise& noise, ceres::LossFunction* loss, Unknowns* unknowns,
                                     std::vector<Preintegration>* terms, ceres::Problem* problem) {
  const double w_p = noise.position * std::sqrt(noise.position_correlation),
               w_r = noise.rotation * std::sqrt(noise.rotation_correlation);
  auto* manifold = new PoseManifold;
  problem->AddParameterBlock(unknowns->extrinsic.data(), 7, manifold);
  terms->resize(states_.size());
  for (std::size_t k = 0; k < states_.size(); ++k) {
    StateBlocks& b = states_[k];
    problem->AddParameterBlock(b.pose.data(), 7, manifold);
    const Utime t = camera_[k].t + values_.offset;
    problem->AddResidualBlock(new CameraPoseFactor(camera_[k].pose, imu_->At(t).gyro, w_p, w_r), loss,
                              b.pose.data(), b.motion.data(), unknowns->extrinsic.data(),
                              unknowns->tilt.data(), &unknowns->late);
    if (k == 0) continue;
    StateBlocks& a = states_[k - 1];
    (*terms)[k] = Preintegration(imu_->Between(camera_[k - 1].t + values_.offset, t), FromBlocks(a).bias,
                                 rig_.imu_noise);
    problem->AddResidualBlock(new ImuFactor(ImuTerm(&(*terms)[k], rig_.gravity, noise_factor_)), nullptr,
                              a.pose.data(), a.motion.data(), b.pose.data(), b.motion.data());
  }
}

void CameraImuBatch::AddPriors(const CameraImuPrior& prior, Unknowns* unknowns, ceres::Problem* problem) {
  StatePrior bias;
  bias.mean = FromBlocks(states_[0]);
  bias.mean.bias = {};
  bias.information.diagonal().segment<3>(9).setConstant(std::pow(prior.gyro_bias_sigma, -2));
  bias.information.diagonal().segment<3>(12).setConstant(std::pow(prior.accel_bias_sigma, -2));
  problem->AddResidualBlock(new PriorFactor(bias), nullptr, states_[0].pose.data(), states_[0].motion.data());
  problem->AddResidualBlock(
      new RigPriorFactor(prior.T_body_camera, ToSeconds(prior.offset - values_.offset), prior.information),
      nullptr, unknowns->extrinsic.data(), &unknowns->late);
  const ceres::Matrix tilt_weight = ceres::Matrix::Identity(2, 2) / prior.tilt_sigma;
  problem->AddResidualBlock(new ceres::NormalPrior(tilt_weight, ceres::Vector::Zero(2)), nullptr,
                            unknowns->tilt.data());
}

bool CameraImuBatch::ComputeCovariance(Unknowns* unknowns, ceres::Problem* problem) {
  // The order of LastCovariance; the middle state's velocity goes before its biases, which are asked for.
  const std::size_t middle = states_.size() / 2;
  std::vector<double*> blocks;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    blocks.push_back(states_[k].pose.data());
    if (k != middle) blocks.push_back(states_[k].motion.data());
  }
  blocks.insert(blocks.end(), {states_[middle].motion.data(), unknowns->extrinsic.data(), &unknowns->late,
                               unknowns->tilt.data()});
  CameraImuCovariance last;  // biases 6, extrinsic 6, offset 1, tilt 2
  if (!LastCovariance(problem, blocks, &last)) return false;
  constexpr int kFrom[15] = {6, 7, 8, 9, 10, 11, 12, 13, 14, 0, 1, 2, 3, 4, 5};
  for (int r = 0; r < 15; ++r) {
    for (int c = 0; c < 15; ++c) covariance_(r, c) = last(kFrom[r], kFrom[c]);
  }
  return true;
}

bool CameraImuBatch::SolveOnce(const CameraImuPrior& prior, const PoseNoise& noise, bool robust,
                               Utime* moved) {
  if (!imu_->Covers(camera_.front().t + values_.offset) || !imu_->Covers(camera_.back().t + values_.offset))
    return false;  // the offset ran away
  Unknowns unknowns{ToBlocks({values_.T_body_camera, Eigen::Vector3d::Zero(), {}}).pose, values_.tilt, 0};
  std::vector<Preintegration> terms;
  const std::unique_ptr<ceres::LossFunction> loss(robust ? new ceres::CauchyLoss(kCauchy) : nullptr);
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  AddMeasurements(noise, loss.get(), &unknowns, &terms, &problem);
  AddPriors(prior, &unknowns, &problem);

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 30;
  options.function_tolerance = 1e-8;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable() || !ComputeCovariance(&unknowns, &problem)) return false;

  values_.T_body_camera = PoseFromBlock(unknowns.extrinsic.data());
  values_.T_body_camera.q.normalize();
  *moved = std::llround(unknowns.late * 1e6);
  values_.offset += *moved;
  values_.tilt = unknowns.tilt;
  values_.bias = FromBlocks(states_[states_.size() / 2]).bias;
  return true;
}

Eigen::Matrix<double, 6, 1> CameraImuBatch::Residual(std::size_t k) const {
  const CameraPoseFactor factor(camera_[k].pose, Eigen::Vector3d::Zero(), 1, 1);
  const std::array<double, 7> extrinsic = ToBlocks({values_.T_body_camera, Eigen::Vector3d::Zero(), {}}).pose;
  const double late = 0;
  const double* parameters[5] = {states_[k].pose.data(), states_[k].motion.data(), extrinsic.data(),
                                 values_.tilt.data(), &late};
  Eigen::Matrix<double, 6, 1> r;
  factor.Evaluate(parameters, r.data(), nullptr);
  return r;
}

PoseNoise CameraImuBatch::MeasureNoise() const {
  std::vector<Eigen::Matrix<double, 6, 1>> residuals;
  for (std::size_t k = 0; k < states_.size(); ++k) residuals.push_back(Residual(k));
  return MeasurePoseNoise(residuals);
}

int CameraImuBatch::RemoveOutliers(const PoseNoise& noise, double sigmas) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const Eigen::Matrix<double, 6, 1> r = Residual(k);
    if (r.head<3>().norm() > sigmas * noise.position || r.tail<3>().norm() > sigmas * noise.rotation)
      continue;
    states_[kept] = states_[k];
    camera_[kept++] = camera_[k];
  }
  const auto removed = static_cast<int>(states_.size() - kept);
  states_.resize(kept);
  camera_.resize(kept);
  return removed;
}

}  // namespace evit
