#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/map/point_map.h"

namespace evit::pictures {

/// A map seen from above (x to the right, y up, as a plan), to draw more onto.
struct TopView {
  cv::Mat picture;     // BGR
  double scale = 1;    // pixels per metre
  cv::Point2d origin;  // pixel of (0, 0) of the map

  cv::Point2d At(double x, double y) const { return {origin.x + scale * x, origin.y - scale * y}; }
};

/// Draws a map coloured by height, with a scale bar and the origin's axes. Strays far off the rest are left
/// out of the frame; `also`: points (x, y) of the map frame that must be in it. `side`: pixels of the plan's
/// longer side. Requires at least one point.
TopView DrawTopView(const PointMap& map, int side, const std::vector<Eigen::Vector2d>& also = {},
                    const std::string& height = "z");

/// The same as a picture file (PNG by the name's extension). `height`: the name of what the colours show,
/// where the map has been turned. Throws std::runtime_error naming the file where it cannot be written.
void WriteTopView(const std::string& path, const PointMap& map, const std::string& height = "z");

}  // namespace evit::pictures
