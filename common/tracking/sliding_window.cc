#include "common/tracking/sliding_window.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include "common/tracking/alignment_information.h"
#include "common/tracking/ceres_factors.h"
#include "common/tracking/pose_manifold.h"

namespace evit {

SlidingWindow::SlidingWindow(AlignmentSettings alignment, double gravity, const WindowOptions& options)
    : alignment_(std::move(alignment)), gravity_(gravity), options_(options) {}

void SlidingWindow::Start(std::deque<WindowNode> nodes, const StatePrior& prior) {
  nodes_ = std::move(nodes);
  prior_ = prior;
}

ImuTerm SlidingWindow::Term(const WindowNode& node) const {
  return ImuTerm(node.imu.get(), gravity_, options_.imu_noise_factor);
}

AlignmentTerm SlidingWindow::Align(const WindowNode& node) const {
  AlignmentTerm term =
      EvaluateAlignment(alignment_, *node.field, 0, node.points, node.state.T_map_body, true);
  // The Hessian of a solver's step claims more than there is to know: it would make the prior sure of noise.
  term.hessian = AlignmentInformation(alignment_, *node.field, node.points, node.state.T_map_body);
  return term;
}

StatePrior SlidingWindow::Eliminate(const StatePrior& prior, const AlignmentTerm& alignment,
                                    std::size_t n) const {
  return Marginalize(prior, alignment, Term(nodes_[n + 1]), nodes_[n].state, nodes_[n + 1].state);
}

void SlidingWindow::Push(WindowNode node) {
  if (nodes_.size() >= static_cast<std::size_t>(options_.size)) {
    if (options_.first_node == WindowOptions::FirstNode::kPrior)
      prior_ = Eliminate(prior_, Align(nodes_.front()), 0);
    nodes_.pop_front();
  }
  nodes_.push_back(std::move(node));
}

SlidingWindow::Summary SlidingWindow::Solve() {
  std::vector<StateBlocks> blocks;
  blocks.reserve(nodes_.size());
  for (WindowNode& node : nodes_) {
    blocks.push_back(ToBlocks(node.state));
    if (node.imu && node.imu->NeedsRepropagation(node.state.bias)) node.imu->Repropagate(node.state.bias);
  }
  ceres::Problem problem;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const WindowNode& node = nodes_[n];
    problem.AddParameterBlock(blocks[n].pose.data(), 7, new PoseManifold);
    problem.AddParameterBlock(blocks[n].motion.data(), 9);
    problem.AddResidualBlock(new EventAlignmentFactor(&alignment_, node.field.get(), 0, &node.points),
                             nullptr, blocks[n].pose.data());
    if (n > 0) {
      problem.AddResidualBlock(new ImuFactor(Term(node)), nullptr, blocks[n - 1].pose.data(),
                               blocks[n - 1].motion.data(), blocks[n].pose.data(), blocks[n].motion.data());
    }
  }
  if (options_.first_node == WindowOptions::FirstNode::kPrior) {
    problem.AddResidualBlock(new PriorFactor(prior_), nullptr, blocks[0].pose.data(),
                             blocks[0].motion.data());
  } else if (nodes_.size() > 1) {
    problem.SetParameterBlockConstant(blocks[0].pose.data());
    problem.SetParameterBlockConstant(blocks[0].motion.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = options_.max_iterations;
  options.function_tolerance = 1e-5;
  options.logging_type = ceres::SILENT;
  if (time_budget_ > 0) options.max_solver_time_in_seconds = time_budget_;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  Summary result;
  result.iterations = static_cast<int>(summary.iterations.size());
  result.usable = summary.IsSolutionUsable();
  if (!result.usable) return result;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    nodes_[n].state = FromBlocks(blocks[n]);
    nodes_[n].state.T_map_body.q.normalize();
  }
  // Once per keyframe is enough: later moves of a node are far smaller than what would change its curvature.
  for (WindowNode& node : nodes_) {
    if (node.alignment.cost == 0) node.alignment = Align(node);
  }
  return result;
}

void SlidingWindow::DropNewestAlignment(const std::vector<BodyState>& states) {
  for (std::size_t n = 0; n < nodes_.size(); ++n) nodes_[n].state = states[n];
  nodes_.back().points = {};
  nodes_.back().alignment = {};
}

Matrix15d SlidingWindow::NewestInformation() const {
  StatePrior prior = prior_;
  if (options_.first_node == WindowOptions::FirstNode::kFixed)
    prior.information = 1e12 * Matrix15d::Identity();
  prior.mean = nodes_.front().state;  // only the information matters here
  for (std::size_t n = 0; n + 1 < nodes_.size(); ++n) prior = Eliminate(prior, nodes_[n].alignment, n);
  Matrix15d information = prior.information;
  information.topLeftCorner<6, 6>() += nodes_.back().alignment.hessian;
  return 0.5 * (information + information.transpose());
}

}  // namespace evit
