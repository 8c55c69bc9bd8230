#pragma once

#include <string>

#include "common/overlap/surface_values.h"
#include "tools/calibration/overlap_run.h"

namespace evit::calibration {

/// How a recording, its map and its known poses fit together: what tells a real sensor and map from simulated
/// ones.
struct OverlapStatistics {
  MapEventOverlap overlap;
  SurfaceValues surface;
  double speed_px = 0;    // pixels/s: mean over the views of the points' median
  double event_rate = 0;  // events/s, mean over the views' slices
};

/// Reads the files. Throws std::runtime_error naming the file and what is wrong.
OverlapStatistics MeasureFiles(const OverlapFiles& files, const Rig& rig);

/// Two lines of a Markdown table, and one for each recording.
std::string StatisticsHeader();
std::string StatisticsRow(const std::string& name, const OverlapStatistics& statistics);

}  // namespace evit::calibration
