#pragma once

#include <string>

#include "common/geometry/rig.h"
#include "common/map/map_index.h"
#include "tools/paper/keyframe_log.h"

namespace evit::paper {

/// The paper's Fig. 1: one window of keyframes, the one that spans the longest way: the map from above with
/// each camera's field of view, the cameras again at a larger scale, joined by their IMU terms, and each time
/// surface with the map on it. Writes a PNG. Throws std::runtime_error: no whole window recorded, or the file
/// cannot be written.
void DrawWindow(const std::string& path, const std::string& title, const KeyframeLog& log, const Rig& rig,
                const MapIndex& map);

}  // namespace evit::paper
