#pragma once

#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "tools/pictures/time_axis.h"

namespace evit::pictures {

/// Draws a run: position and orientation over time, their errors and the path from above; the truth also
/// where there are no poses. Without truth (empty) the error charts say so. `breaks`: stamps of poses of the
/// estimate, in order, that no line joins to the one before, beside those that come long after it. Writes a
/// PNG; throws std::runtime_error naming the file.
void PlotRun(const std::string& path, const std::string& title, const Trajectory& truth,
             const Trajectory& estimate, const TimeAxis& time, const std::vector<Utime>& breaks = {});

}  // namespace evit::pictures
