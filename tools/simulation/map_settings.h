#pragma once

#include <cstddef>

#include "tools/simulation/image_map.h"
#include "tools/simulation/map_holes.h"

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
  MapHoles holes;
  ImageMapSettings images;  // on: in place of the depth camera, with its own errors
};

}  // namespace evit::simulation
