#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/geometry/rig.h"
#include "common/map/point_map.h"
#include "tools/simulation/edge_pixels.h"
#include "tools/simulation/map_settings.h"
#include "tools/simulation/pose_spline.h"
#include "tools/simulation/renderer.h"

namespace evit::simulation {

/// Stamps of the views a map is made from: each at some distance or angle from all before.
std::vector<Utime> ChooseMapViews(const PoseSpline& motion, Utime begin, Utime end,
                                  const MapSettings& settings);

/// By how much view i is misplaced, m, in the map frame.
Eigen::Vector3d ViewMisplacement(const MapSettings& settings, std::uint64_t seed, int i);

/// The map that posed depth views along the path would give, or posed images where settings.images is on:
/// edges put into space, in random (seeded) order.
PointMap MakeEdgeMap(const Renderer& renderer, const Rig& rig, const PoseSpline& motion, Utime begin,
                     Utime end, const MapSettings& settings, std::uint64_t seed, int threads, int* n_views);

}  // namespace evit::simulation
