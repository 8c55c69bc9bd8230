#pragma once

#include <string>
#include <vector>

#include "common/evaluation/consistency.h"
#include "tools/pictures/time_axis.h"

namespace evit::pictures {

/// Draws the error of each of the six components of the pose over time, between its 2-sigma bounds. Where
/// there is no truth the charts say so. `breaks`: as in PlotRun. Writes a PNG; throws std::runtime_error
/// naming the file.
void PlotConsistency(const std::string& path, const std::string& title, const Consistency& consistency,
                     const TimeAxis& time, const std::vector<Utime>& breaks = {});

}  // namespace evit::pictures
