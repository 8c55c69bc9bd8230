#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "common/localization/event_panorama.h"
#include "common/localization/place_index.h"

namespace evit {

/// Where a panorama of events looks like the map.
struct PlaceMatch {
  Eigen::Vector3f at;  // of the viewer, map frame, m
  double yaw = 0;      // rad: of the upright frame over the map's
  double score = 0;    // standard deviations above edges at random
};

/// The best `count` of all places at all yaws, best first; none is a direct neighbour of a better one.
/// `allowed`: which places (m) and yaws (rad) are possible; empty: all.
std::vector<PlaceMatch> BestMatches(const PlaceIndex& index, const EventPanorama& events, std::size_t count,
                                    const std::function<bool(const Eigen::Vector3f&, double)>& allowed,
                                    int threads);

}  // namespace evit
