#pragma once

#include <string>

#include "common/map/point_map.h"

namespace evit {

/// Draws a map seen from above (x to the right, y up, as a plan), coloured by height, with a scale bar and
/// the origin's axes, and writes it as a picture (PNG by the name's extension). Strays far off the rest are
/// left out of the frame. Requires at least one point. Throws std::runtime_error naming the file where it
/// cannot be written.
void WriteTopView(const std::string& path, const PointMap& map);

}  // namespace evit
