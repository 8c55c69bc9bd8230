#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "tools/simulation/renderer.h"

namespace evit::simulation {

/// A point on an edge in the image: where, and the inverse depth of the nearer surface there.
struct EdgePixel {
  Eigen::Vector2d pixel;   // subpixel
  Eigen::Vector2d normal;  // unit, along the gradient
  double inverse_depth;    // 1/m
};

/// Local maxima of the gradient of an image (CV_32F, of the view's size) along its direction, `threshold` per
/// pixel or more. Smooths the image first, by 0.8 px.
std::vector<EdgePixel> FindEdgesIn(cv::Mat image, const View& view, double threshold);

/// The same of log intensity.
std::vector<EdgePixel> FindEdges(const View& view, int width, int height, double threshold);

}  // namespace evit::simulation
