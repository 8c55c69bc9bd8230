#pragma once

#include <cstddef>

#include "common/map/point_map.h"

namespace evit {

struct DenoiseSettings {
  double radius = 0;       // m: within which neighbours count
  int min_neighbours = 5;  // including the point itself; with fewer it stays as it is
};

struct DenoiseSummary {
  std::size_t n_moved = 0;
  std::size_t n_dropped = 0;
};

/// For this map, whose points have `spacing` (m, MapSummary::median_spacing): a radius that reaches a usual
/// point's next neighbours along its edge and across the bundle of points around it, and no farther, as the
/// next edge is another one. A map that knows its points' sigmas gets none: `evit map build` has thinned it.
DenoiseSettings DenoiseSettingsFor(const PointMap& map, double spacing);

/// Thins the bundle of points that many noisy views leave around each edge: a point moves onto the line
/// through its neighbours (their weighted mean and principal direction: one step of moving least squares), so
/// that a tracker's few thousand points know what all points of the map know. Points without any neighbour
/// are left out where most have enough of them: strays, which would make the map seem larger than it is.
/// Keeps the order of points. Same map, same result. Radius 0: leaves all as it is.
DenoiseSummary Denoise(const DenoiseSettings& settings, PointMap* map);

}  // namespace evit
