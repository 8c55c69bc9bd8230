#pragma once

#include <functional>
#include <vector>

#include "common/tracking/state.h"

namespace evit {

/// An objective over a chain of states, of which neighbours alone are joined, as a quadratic function around
/// given states: cost, gradient and Hessian over their tangents.
struct ChainModel {
  explicit ChainModel(std::size_t n);

  double cost = 0;
  std::vector<Vector15d> gradient;
  std::vector<Matrix15d> diagonal;  // Hessian: of each state
  std::vector<Matrix15d> upper;     // of each but the last with the next
};

/// When to stop.
struct ChainOptions {
  int max_iterations = 12;
  /// An iteration that lowers the cost by less is the last. The cost is half a chi-square: 0.01 is a seventh
  /// of a standard deviation, however many residuals there are.
  double least_gain = 0.01;
  double time_budget = 0;  // s; 0: none
};

struct ChainSummary {
  int iterations = 0;   // evaluations of the objective
  bool usable = false;  // the states are finite, and no worse than the first
};

/// Moves the states to where the objective is least (Levenberg-Marquardt; the linear system is solved from
/// block to block, oldest first, at a cost that grows linearly with the number of states). `evaluate` must be
/// deterministic; positive semi-definite models always give a step.
ChainSummary MinimizeChain(const ChainOptions& options,
                           const std::function<ChainModel(const std::vector<BodyState>&)>& evaluate,
                           std::vector<BodyState>* states);

}  // namespace evit
