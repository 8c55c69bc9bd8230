#pragma once

#include <cstdint>

#include "common/map/point_map.h"

namespace evit::simulation {

/// Parts of the map that are missing.
struct MapHoles {
  double share = 0;       // of the points, 0..1
  double diameter_m = 0;  // of each hole
};

/// Takes balls of points out of the map, each about a random point that is left, until `share` of the points
/// is gone; the last ball takes no more than is still to go. The others stay in order.
void CutHoles(const MapHoles& holes, std::uint64_t seed, PointMap* map);

}  // namespace evit::simulation
