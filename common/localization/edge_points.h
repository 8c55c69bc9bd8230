#pragma once

#include <cstddef>
#include <vector>

#include "common/map/point_map.h"

namespace evit {

/// A point of a thinned map, with the direction of the edge it lies on.
struct EdgePoint {
  Eigen::Vector3f at = Eigen::Vector3f::Zero();     // map frame, m
  Eigen::Vector3f along = Eigen::Vector3f::Zero();  // unit, sign arbitrary; zero where the map shows no line
};

struct EdgePointOptions {
  double spacing = 0.03;            // m: one point for each cube of this size, larger where that is too many
  double radius = 0.06;             // m: neighbours that the direction comes from
  std::size_t max_points = 40'000;  // in all
};

/// The map with one point for each cube that holds any, and their directions (principal direction of the
/// neighbours, where it stands out). Same map, same result.
std::vector<EdgePoint> ThinEdges(const PointMap& map, const EdgePointOptions& options);

}  // namespace evit
