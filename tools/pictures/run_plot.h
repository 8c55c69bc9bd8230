#pragma once

#include <string>

#include "common/evaluation/trajectory.h"

namespace evit::pictures {

/// Draws a run: position and orientation over time, their errors and the path from above. Without truth
/// (empty) the error charts say so. Writes a PNG; throws std::runtime_error naming the file.
void PlotRun(const std::string& path, const std::string& title, const Trajectory& truth,
             const Trajectory& estimate);

}  // namespace evit::pictures
