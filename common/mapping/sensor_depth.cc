#include "common/mapping/sensor_depth.h"

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

// Depth on one side of an edge, extended to the edge; 0: none.
double Beside(const cv::Mat& depth, const EdgePixel& edge, float side, const SensorDepthOptions& options) {
  const auto at = [&](float off) {
    const Eigen::Vector2f p = edge.pixel + side * off * edge.normal;
    const long column = std::lround(p.x()), row = std::lround(p.y());
    if (column < 0 || row < 0 || column >= depth.cols || row >= depth.rows) return 0.0;
    const double z = depth.at<float>(static_cast<int>(row), static_cast<int>(column));
    return z >= options.min_depth_m && z <= options.max_depth_m ? z : 0.0;
  };
  // Depth that was registered to another camera has holes of one pixel between those it fills.
  const float off = at(2) > 0 ? 2 : 3;
  const double near = at(off), far = at(off + 2);
  if (near == 0 || far == 0) return near > 0 ? near : far;
  if (std::abs(near - far) > options.jump * near) return std::min(near, far);
  return near + (near - far) * off / 2;  // so much farther on the same surface
}

}  // namespace

std::vector<EdgeDepth> DepthsFromImage(const PosedEdges& view, const cv::Mat& depth,
                                       const SensorDepthOptions& options) {
  CV_Assert(depth.type() == CV_32FC1);
  std::vector<EdgeDepth> depths;
  const std::vector<EdgePixel>& edges = view.edges.edges();
  for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
    const double a = Beside(depth, edges[e], 1, options), b = Beside(depth, edges[e], -1, options);
    if (a == 0 && b == 0) continue;
    double z = a == 0 ? b : (b == 0 ? a : std::min(a, b));
    if (a > 0 && b > 0 && std::abs(a - b) < options.jump * z) z = (a + b) / 2;
    depths.push_back({e, 1 / z, options.relative_sigma / z, 0, 1});
  }
  return depths;
}

}  // namespace evit
