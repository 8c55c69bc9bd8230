#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/map/point_map.h"

namespace evit::mapping {

/// How far the points of one map lie from the nearest of another.
struct MapDistance {
  std::size_t points = 0;
  double median_m = 0, p95_m = 0;  // no larger than the reach
  double beyond = 0;               // share of the points that lie farther than the limit
  double median_share = 0;         // of a point's own distance from a path; 0: no path was given
};

/// How far points lie from the nearest place of a path.
class PathDistance {
 public:
  /// Places less than 2 cm from the one before say nothing new and are left out. Requires a pose.
  explicit PathDistance(const Trajectory& path);

  double Of(const Eigen::Vector3f& p) const;  // m
  /// The points (without attributes) from `min_m` to `max_m` away.
  PointMap Between(const PointMap& map, double min_m, double max_m) const;

 private:
  std::vector<Eigen::Vector3f> places_;
};

/// `limit_m`: what counts as beyond; `reach_m`: up to where distances are measured. Requires points in both.
/// `path`: may be null.
MapDistance DistanceBetween(const PointMap& from, const PointMap& to, const PathDistance* path,
                            double limit_m, double reach_m = 0.1);

/// Both ways, in words: how exact `map` is, and how much of the reference it has. JSON where `json`.
std::string CompareText(const std::string& map, const MapDistance& exact, const std::string& reference,
                        const MapDistance& complete, double limit_m, bool json);

}  // namespace evit::mapping
