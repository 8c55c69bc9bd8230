#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/map/map_index.h"
#include "evit/map_points_t.hpp"
#include "evit/map_query_t.hpp"

/// Questions to map_server and its answers. Incoming messages must have been checked (DecodeChecked); utime,
/// seq and epoch are the caller's.
namespace evit {

map_query_t ToMessage(const VisibilityQuery& query);
VisibilityQuery FromMessage(const map_query_t& message);

/// `map`: the one that `answer` indexes.
map_points_t ToMessage(const VisibilityAnswer& answer, const PointMap& map);
/// Points of an answer, map frame, m.
std::vector<Eigen::Vector3f> PointsOf(const map_points_t& message);

}  // namespace evit
