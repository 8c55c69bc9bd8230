#include "tools/paper/summary.h"

#include <algorithm>

namespace evit::paper {

Spread SpreadOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return {values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]),
          values.back()};
}

Summary Summarize(const std::vector<RunScore>& runs) {
  Summary summary;
  summary.seeds = static_cast<int>(runs.size());
  for (std::size_t a = 0; a < kAlignments.size(); ++a) {
    for (std::size_t m = 0; m < kMilestones.size(); ++m) {
      std::vector<double> position, orientation;
      for (const RunScore& run : runs) {
        if (!run.ate[a][m]) continue;
        position.push_back(run.ate[a][m]->position_cm);
        orientation.push_back(run.ate[a][m]->orientation_deg);
      }
      Summary::Milestone& out = summary.ate[a][m];
      out.reached = static_cast<int>(position.size());
      if (out.reached < summary.seeds) continue;
      out.position_cm = SpreadOf(position);
      out.orientation_deg = SpreadOf(orientation);
    }
  }
  std::vector<double> rate, cpu;
  for (const RunScore& run : runs) rate.push_back(run.keyframe_rate_hz), cpu.push_back(run.cpu_s_per_s);
  summary.keyframe_rate_hz = SpreadOf(rate);
  summary.cpu_s_per_s = SpreadOf(cpu);
  return summary;
}

}  // namespace evit::paper
