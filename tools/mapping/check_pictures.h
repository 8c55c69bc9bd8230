#pragma once

#include <string>

#include "tools/mapping/map_check.h"

namespace evit::mapping {

/// The views that fit best, in the middle and worst, with events, points on events and points beside them, as
/// best.png, median.png and worst.png in `folder` (made).
void WriteCheckPictures(const std::string& folder, const std::string& rig, const MapCheck& check);

}  // namespace evit::mapping
