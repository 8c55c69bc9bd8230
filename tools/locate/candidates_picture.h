#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/geometry/rig.h"
#include "common/localization/place_query.h"
#include "common/map/map_index.h"

namespace evit::locate {

/// The best candidates side by side: the events (grey) and what the map would show from there (red). Throws
/// std::runtime_error naming the file where it cannot be written.
void WriteCandidates(const std::string& path, const cv::Mat& surface, const MapIndex& map, const Rig& rig,
                     const std::vector<PlaceCandidate>& candidates, std::size_t count = 3);

}  // namespace evit::locate
