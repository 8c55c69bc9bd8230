#include "common/tracking/visual_inertial_alignment.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>

#include "common/text/format_text.h"
#include "common/tracking/ceres_factors.h"
#include "common/tracking/pose_manifold.h"

namespace evit {
namespace {

// Velocity at frame k from poses some frames apart: a short difference would be all noise.
Eigen::Vector3d DifferenceVelocity(const std::vector<BootstrapFrame>& frames, std::size_t k) {
  const std::size_t reach = std::max<std::size_t>(1, frames.size() / 4);
  const std::size_t a = k > reach ? k - reach : 0, b = std::min(frames.size() - 1, k + reach);
  return (frames[b].T_map_body.p - frames[a].T_map_body.p) / ToSeconds(frames[b].t - frames[a].t);
}

bool SolveChain(const std::vector<BootstrapFrame>& frames, double gravity, double noise_factor,
                const std::vector<StatePrior>& priors, std::vector<StateBlocks>* blocks) {
  ceres::Problem problem;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    StateBlocks& b = (*blocks)[k];
    problem.AddParameterBlock(b.pose.data(), 7, new PoseManifold);
    problem.AddResidualBlock(new PriorFactor(priors[k]), nullptr, b.pose.data(), b.motion.data());
    if (k == 0) continue;
    StateBlocks& a = (*blocks)[k - 1];
    problem.AddResidualBlock(new ImuFactor(ImuTerm(frames[k].imu.get(), gravity, noise_factor)), nullptr,
                             a.pose.data(), a.motion.data(), b.pose.data(), b.motion.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 20;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.IsSolutionUsable();
}

}  // namespace

VisualInertialAlignment AlignVisualInertial(const std::vector<BootstrapFrame>& frames, double gravity,
                                            const BootstrapOptions& options, double imu_noise_factor,
                                            double position_sigma, double rotation_sigma) {
  VisualInertialAlignment result;
  if (frames.size() < 3) {
    result.reason = "fewer than three frames";
    return result;
  }
  std::vector<StateBlocks> blocks;
  std::vector<StatePrior> priors(frames.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    BodyState state;
    state.T_map_body = frames[k].T_map_body;
    state.velocity = DifferenceVelocity(frames, k);
    blocks.push_back(ToBlocks(state));
    priors[k].mean = state;
    priors[k].information.diagonal().segment<3>(0).setConstant(1 / (position_sigma * position_sigma));
    priors[k].information.diagonal().segment<3>(3).setConstant(1 / (rotation_sigma * rotation_sigma));
  }
  // A third of what would be refused is taken as one standard deviation of a sound sensor.
  const double gyro_sigma = options.max_gyro_bias / 3, accel_sigma = options.max_accel_bias / 3;
  priors[0].information.diagonal().segment<3>(9).setConstant(1 / (gyro_sigma * gyro_sigma));
  priors[0].information.diagonal().segment<3>(12).setConstant(1 / (accel_sigma * accel_sigma));

  for (int pass = 0; pass < 2; ++pass) {
    if (!SolveChain(frames, gravity, imu_noise_factor, priors, &blocks)) {
      result.reason = "the alignment did not converge";
      return result;
    }
    for (std::size_t k = 1; k < frames.size(); ++k)
      frames[k].imu->Repropagate(FromBlocks(blocks[k - 1]).bias);
  }
  for (const StateBlocks& b : blocks) result.states.push_back(FromBlocks(b));
  const ImuBias& bias = result.states.back().bias;
  if (bias.gyro.norm() > options.max_gyro_bias || bias.accel.norm() > options.max_accel_bias) {
    result.reason = FormatText("biases too large: gyro %.3f rad/s, accel %.2f m/s^2; is the map's z axis up?",
                               bias.gyro.norm(), bias.accel.norm());
    return result;
  }
  result.success = true;
  return result;
}

}  // namespace evit
