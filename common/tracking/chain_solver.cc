#include "common/tracking/chain_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace evit {
namespace {

// The trust region of Madsen, Nielsen and Tingleff, "Methods for non-linear least squares problems" (2004),
// with the bounds that Ceres uses.
constexpr double kFirstRadius = 1e4, kLeastRadius = 1e-32, kLeastDiagonal = 1e-6;
constexpr double kLeastGain = 1e-3;  // of the cost, as a share of what the model promises

using Steps = std::vector<Vector15d>;

struct Step {
  Steps states;
  double promised = 0;  // by how much the model's cost falls
};

// The minimum of the model with its diagonal made larger by 1/radius.
Step SolveDamped(const ChainModel& model, double radius) {
  const std::size_t n = model.diagonal.size();
  using Wide = Eigen::Matrix<double, 15, 16>;
  std::vector<Wide> solved(n);  // of each state: its Schur complement's inverse times (upper, gradient)
  Matrix15d schur;
  Vector15d gradient;
  for (std::size_t k = 0; k < n; ++k) {
    schur = model.diagonal[k];
    schur.diagonal() += model.diagonal[k].diagonal().cwiseMax(kLeastDiagonal) / radius;
    gradient = model.gradient[k];
    if (k > 0) {
      const Wide eliminated = model.upper[k - 1].transpose() * solved[k - 1];
      schur -= eliminated.leftCols<15>();
      gradient -= eliminated.col(15);
    }
    Wide right = Wide::Zero();
    if (k + 1 < n) right.leftCols<15>() = model.upper[k];
    right.col(15) = gradient;
    solved[k] = schur.ldlt().solve(right);
  }
  Step step;
  step.states.resize(n);
  for (std::size_t k = n; k-- > 0;) {
    step.states[k] = -solved[k].col(15);
    if (k + 1 < n) step.states[k] -= solved[k].leftCols<15>() * step.states[k + 1];
  }
  for (std::size_t k = 0; k < n; ++k) {
    const Vector15d& d = step.states[k];
    step.promised -= d.dot(model.gradient[k] + 0.5 * (model.diagonal[k] * d));
    if (k + 1 < n) step.promised -= d.dot(model.upper[k] * step.states[k + 1]);
  }
  return step;
}

bool IsFinite(const ChainModel& model) {
  return std::isfinite(model.cost) && std::all_of(model.gradient.begin(), model.gradient.end(),
                                                  [](const auto& g) { return g.allFinite(); });
}

}  // namespace

ChainModel::ChainModel(std::size_t n)
    : gradient(n, Vector15d::Zero()),
      diagonal(n, Matrix15d::Zero()),
      upper(n > 0 ? n - 1 : 0, Matrix15d::Zero()) {}

ChainSummary MinimizeChain(const ChainOptions& options,
                           const std::function<ChainModel(const std::vector<BodyState>&)>& evaluate,
                           std::vector<BodyState>* states) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const auto out_of_time = [&] {
    return options.time_budget > 0 &&
           std::chrono::duration<double>(Clock::now() - begin).count() > options.time_budget;
  };
  ChainModel model = evaluate(*states);
  ChainSummary summary{1, IsFinite(model)};
  double radius = kFirstRadius, shrink = 2;
  while (summary.usable && summary.iterations <= options.max_iterations && !out_of_time() &&
         radius > kLeastRadius) {
    const Step step = SolveDamped(model, radius);
    std::vector<BodyState> moved;
    moved.reserve(states->size());
    for (std::size_t k = 0; k < states->size(); ++k) moved.push_back(Plus((*states)[k], step.states[k]));
    ++summary.iterations;
    ChainModel next = evaluate(moved);
    const double gain = (model.cost - next.cost) / step.promised;
    if (!IsFinite(next) || !(gain > kLeastGain)) {
      if (step.promised <= options.least_gain) break;  // there is nothing left to gain
      radius /= shrink;
      shrink *= 2;
      continue;
    }
    const bool last = model.cost - next.cost <= options.least_gain;
    *states = std::move(moved);
    model = std::move(next);
    if (last) break;
    radius /= std::max(1.0 / 3, 1 - std::pow(2 * gain - 1, 3));
    shrink = 2;
  }
  return summary;
}

}  // namespace evit
