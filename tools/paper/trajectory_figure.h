#pragma once

#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"

namespace evit::paper {

/// One method's trajectory, as long as it tracked.
struct MethodTrajectory {
  std::string name;
  Trajectory poses;
};

/// The paper's Fig. evo_traj: position (x, y, z) and rotation since the start (about the map's x, y and z
/// axes) over time, every method against truth, each aligned by its first pair of poses. A curve ends, with a
/// dot, where its method was lost; what is far from the truth is cut off. Writes a PNG; throws
/// std::runtime_error naming the file.
void DrawTrajectories(const std::string& path, const std::string& title, const Trajectory& truth,
                      const std::vector<MethodTrajectory>& methods);

}  // namespace evit::paper
