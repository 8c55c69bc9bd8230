#pragma once

#include <string>

#include "common/geometry/rig.h"
#include "common/map/map_index.h"
#include "tools/paper/keyframe_log.h"

namespace evit::paper {

/// The paper's Fig. motion_model: a keyframe's time surface with the map projected onto it from where each
/// motion model expects the camera, and from where the window then found it. Of all keyframes recorded it
/// takes the one whose constant-velocity prediction is farthest off. Writes a PNG. Throws std::runtime_error:
/// no keyframe with a window before it, or the file cannot be written.
void DrawMotionModels(const std::string& path, const std::string& title, const KeyframeLog& log,
                      const Rig& rig, const MapIndex& map);

}  // namespace evit::paper
