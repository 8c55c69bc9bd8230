#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/photometric/photometric_view.h"

namespace evit {

/// Places of the map with a brightness gradient, taken from a view of it.
struct GradientPoint {
  Eigen::Vector3d point;     // m, map frame
  Eigen::Vector3d gradient;  // of log intensity, 1/m, map frame; at right angles to the line of sight
};

/// Of a view made coarser `level` times (2x2 pixels into one) and blurred by `blur_sigma` of its pixels:
/// pixels with at least `min_gradient` (log intensity per pixel of that level), a regular subset of at most
/// `max_points` of them. Beside a jump of depth the nearer surface counts: its border is what moves.
std::vector<GradientPoint> FindGradientPoints(const PhotometricView& view, int level, double blur_sigma,
                                              double min_gradient, int max_points);

}  // namespace evit
