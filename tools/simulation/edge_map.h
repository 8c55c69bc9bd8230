#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/geometry/rig.h"
#include "common/map/point_map.h"
#include "tools/simulation/pose_spline.h"
#include "tools/simulation/renderer.h"

namespace evit::simulation {

/// Errors of a map as a depth camera with posed views would make it.
struct MapSettings {
  double interval_s = 0.25;       // between views that are considered
  double min_move_m = 0.12;       // a view is taken when it is this far from all taken before, or
  double min_turn_deg = 12;       // turned by this much
  double edge_threshold = 0.10;   // of log intensity per pixel
  double depth_noise = 0.006;     // share of the depth
  double edge_noise_px = 0.35;    // across the edge
  double view_jitter_m = 0.0015;  // per axis, one draw a view
  double outlier_share = 0.02;
  double outlier_m = 0.2;            // distance an outlier is moved by
  double voxel_m = 0.006;            // one point for each voxel
  std::size_t max_points = 150'000;  // beyond it, a random part is kept
};

/// A point on an edge in the image: where, and the inverse depth of the nearer surface there.
struct EdgePixel {
  Eigen::Vector2d pixel;   // subpixel
  Eigen::Vector2d normal;  // unit, along the gradient
  double inverse_depth;    // 1/m
};

/// Local maxima of the gradient of log intensity along its direction.
std::vector<EdgePixel> FindEdges(const View& view, int width, int height, double threshold);

/// Stamps of the views a map is made from: each at some distance or angle from all before.
std::vector<Utime> ChooseMapViews(const PoseSpline& motion, Utime begin, Utime end,
                                  const MapSettings& settings);

/// By how much view i is misplaced, m, in the map frame.
Eigen::Vector3d ViewMisplacement(const MapSettings& settings, std::uint64_t seed, int i);

/// The map that posed depth views along the path would give: edges put into space, in random (seeded) order.
PointMap MakeEdgeMap(const Renderer& renderer, const Rig& rig, const PoseSpline& motion, Utime begin,
                     Utime end, const MapSettings& settings, std::uint64_t seed, int threads, int* n_views);

/// Binary PCD, fields x y z as float. Throws std::runtime_error naming the file.
void WriteBinaryPcd(const std::string& path, const PointMap& map);

}  // namespace evit::simulation
