#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace evit {

/// What a map may know of a point beside its place (`evit map build` does).
struct PointAttributes {
  // Unit, along the edge; its brighter side is on the left as the camera saw it. Zero: not known.
  Eigen::Vector3f direction = Eigen::Vector3f::Zero();
  float sigma = 0;     // m, of the place across the edge, in the worst direction; 0: not known
  float views = 0;     // that showed it
  float contrast = 0;  // step of log intensity; 0: not known
};

/// A semi-dense map: points on edges of the scene, map frame (z up), metres.
struct PointMap {
  std::vector<Eigen::Vector3f> points;
  std::vector<PointAttributes> attributes{};  // of each point, or empty
};

/// Drops the points for which keep(k) is false, and their attributes. The others keep their order.
template <typename Keep>
void KeepIf(PointMap* map, const Keep& keep) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < map->points.size(); ++k) {
    if (!keep(k)) continue;
    map->points[kept] = map->points[k];
    if (!map->attributes.empty()) map->attributes[kept] = map->attributes[k];
    ++kept;
  }
  map->points.resize(kept);
  if (!map->attributes.empty()) map->attributes.resize(kept);
}

/// Axis-aligned bounds and typical spacing, to tell a user what was loaded and whether its unit can be
/// metres.
struct MapSummary {
  std::size_t n_points = 0;
  Eigen::Vector3f min = Eigen::Vector3f::Zero(), max = Eigen::Vector3f::Zero(),
                  median = Eigen::Vector3f::Zero();
  double median_spacing = 0;  // m: median distance of a point to its nearest neighbour (of a sample)
};

}  // namespace evit
