#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace evit {

/// A semi-dense map: points on edges of the scene, map frame (z up), metres.
struct PointMap {
  std::vector<Eigen::Vector3f> points;
};

/// Axis-aligned bounds and typical spacing, to tell a user what was loaded and whether its unit can be
/// metres.
struct MapSummary {
  std::size_t n_points = 0;
  Eigen::Vector3f min = Eigen::Vector3f::Zero(), max = Eigen::Vector3f::Zero(),
                  median = Eigen::Vector3f::Zero();
  double median_spacing = 0;  // m: median distance of a point to its nearest neighbour (of a sample)
};

}  // namespace evit
