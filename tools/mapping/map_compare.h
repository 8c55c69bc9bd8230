#pragma once

#include <cstddef>
#include <string>

#include "common/map/point_map.h"

namespace evit::mapping {

/// How far the points of one map lie from the nearest of another.
struct MapDistance {
  std::size_t points = 0;
  double median_m = 0, p95_m = 0;  // no larger than the reach
  double beyond = 0;               // share of the points that lie farther than the limit
};

/// `limit_m`: what counts as beyond; `reach_m`: up to where distances are measured. Requires points in both.
MapDistance DistanceBetween(const PointMap& from, const PointMap& to, double limit_m, double reach_m = 0.1);

/// Both ways, in words: how exact `map` is, and how much of the reference it has. JSON where `json`.
std::string CompareText(const std::string& map, const MapDistance& exact, const std::string& reference,
                        const MapDistance& complete, double limit_m, bool json);

}  // namespace evit::mapping
