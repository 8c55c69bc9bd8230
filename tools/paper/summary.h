#pragma once

#include <optional>
#include <vector>

#include "tools/paper/run_score.h"

namespace evit::paper {

/// Median and worst of one figure over the seeds.
struct Spread {
  double median = 0, worst = 0;
};
/// Requires at least one value. An even number: the mean of the two in the middle.
Spread SpreadOf(std::vector<double> values);

/// One method on one sequence, all seeds.
struct Summary {
  struct Milestone {
    int reached = 0;                                     // in so many seeds
    std::optional<Spread> position_cm, orientation_deg;  // only where it was reached in all of them
  };
  int seeds = 0;
  std::array<std::array<Milestone, kMilestones.size()>, kAlignments.size()> ate;
  Spread keyframe_rate_hz, cpu_s_per_s;
};
/// Requires at least one run.
Summary Summarize(const std::vector<RunScore>& runs);

}  // namespace evit::paper
