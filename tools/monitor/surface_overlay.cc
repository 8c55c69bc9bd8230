#include "tools/monitor/surface_overlay.h"

#include <algorithm>
#include <cmath>

namespace evit::monitor {

std::vector<OverlayPoint> ProjectOnto(const keyframe_t& keyframe, const Camera& camera,
                                      const SE3& T_map_camera, const std::vector<Eigen::Vector3f>& points,
                                      std::size_t limit) {
  std::vector<OverlayPoint> result;
  if (camera.width != keyframe.width || camera.height != keyframe.height) return result;
  const SE3 T_camera_map = T_map_camera.Inverse();
  const std::size_t step =
      std::max<std::size_t>(1, (points.size() + limit - 1) / std::max<std::size_t>(1, limit));
  result.reserve(points.size() / step + 1);
  for (std::size_t i = 0; i < points.size(); i += step) {
    Eigen::Vector2d pixel;
    const Eigen::Vector3d point = T_camera_map * Eigen::Vector3d(points[i].cast<double>());
    if (point.z() <= 0 || !camera.Project(point, &pixel) || !camera.Contains(pixel)) continue;
    const auto column = static_cast<std::size_t>(std::lround(pixel.x()));
    const auto row = static_cast<std::size_t>(std::lround(pixel.y()));
    const std::size_t at = row * static_cast<std::size_t>(keyframe.width) + column;
    result.push_back({static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), keyframe.surface[at]});
  }
  return result;
}

}  // namespace evit::monitor
