#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "common/geometry/se3.h"
#include "tools/simulation/renderer.h"

namespace evit::simulation {

/// Errors of a map as an image-based mapper makes it from posed grey images.
struct ImageMapSettings {
  bool on = false;
  double scale = 0.5;           // size of the images, share of the event camera's
  double gamma = 2.2;           // of their grey levels, 0..255
  double grey_noise = 1.5;      // grey levels
  double grey_threshold = 6;    // grey levels per pixel: an edge
  double match_px = 0.15;       // of a match along the epipolar line, alike along a piece of an edge
  double baseline_m = 0.2;      // between views that are matched
  double piece_m = 0.1;         // length of a piece of an edge
  double missing_share = 0.2;   // of pieces that find no match
  double parallel_deg = 15;     // edges nearer than this to the epipolar line cannot be matched
  double view_turn_deg = 0.07;  // error of a view's pose, per axis: edges seen twice lie beside each other
  double view_move_m = 0.003;
};

/// The camera with images of another size.
Camera ScaledCamera(const Camera& camera, double scale);

/// Edges of one image, put into space as a mapper would that matches along epipolar lines (map frame, m).
/// `renderer`: of the scaled camera. `velocity`: of the camera, map frame: which way views lie beside each
/// other. What goes wrong with a piece of an edge is chance, by `seed`, and the same for some views that
/// follow each other.
std::vector<Eigen::Vector3d> PointsOfImage(const Renderer& renderer, const SE3& T_map_camera,
                                           const Eigen::Vector3d& velocity, const ImageMapSettings& settings,
                                           std::uint64_t seed, int view);

}  // namespace evit::simulation
