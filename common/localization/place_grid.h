#pragma once

#include <array>
#include <vector>

#include "common/localization/edge_points.h"

namespace evit {

struct PlaceGridOptions {
  double spacing = 0.15;            // m: between neighbouring places, larger where that makes too many
  double beyond = 0.75;             // m: places lie in the map's box and so far around it,
  double beyond_open = 2;           // m: and so far on a side where no wall closes it
  std::size_t max_places = 60'000;  // in all
};

/// Places from which a map may have been seen. Whoever made it from a moving camera stood in front of what he
/// saw, and not in the middle of it: where the map has no wall on a side, places lie well beyond it.
struct PlaceGrid {
  double spacing = 0;                   // m, as it is
  std::vector<Eigen::Vector3f> places;  // map frame, m
};
/// `edges`: at least one.
PlaceGrid MakePlaceGrid(const std::vector<EdgePoint>& edges, const PlaceGridOptions& options);

/// Of the box around edges, for x low, x high, y low, y high: whether edges lie all over that side, as on a
/// wall, and not only along its rim, where other walls end.
std::array<bool, 4> ClosedSides(const std::vector<EdgePoint>& edges);

}  // namespace evit
