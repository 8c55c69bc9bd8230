#include "tools/paper/surface_picture.h"

#include <opencv2/imgproc.hpp>

namespace evit::paper {

std::vector<Eigen::Vector3f> VisibleFrom(const MapIndex& map, const Rig& rig, const SE3& T_map_body,
                                         int most) {
  VisibilityQuery query;
  query.T_map_camera = T_map_body * rig.T_body_camera;
  query.camera = rig.camera;
  query.max_points = most;
  query.seed = 1;
  std::vector<Eigen::Vector3f> points;
  for (const std::int32_t id : map.Query(query).ids) points.push_back(map.map().points[id]);
  return points;
}

cv::Mat SurfaceWithPoints(const RecordedKeyframe& keyframe, const Rig& rig,
                          const std::vector<Eigen::Vector3f>& points, const SE3& T_map_body,
                          const cv::Scalar& color, double zoom) {
  cv::Mat gray(keyframe.height, keyframe.width, CV_8U), picture;
  std::copy(keyframe.surface.begin(), keyframe.surface.end(), gray.begin<std::uint8_t>());
  cv::cvtColor(gray, picture, cv::COLOR_GRAY2BGR);
  cv::resize(picture, picture, {}, zoom, zoom, zoom < 1 ? cv::INTER_AREA : cv::INTER_CUBIC);
  const SE3 T_camera_map = (T_map_body * rig.T_body_camera).Inverse();
  constexpr int kShift = 4;
  for (const Eigen::Vector3f& point : points) {
    Eigen::Vector2d pixel;
    if (!rig.camera.Project(T_camera_map * point.cast<double>(), &pixel) || !rig.camera.Contains(pixel))
      continue;
    const Eigen::Vector2d at = (zoom * (pixel.array() + 0.5) - 0.5) * (1 << kShift);
    cv::circle(picture, {static_cast<int>(at.x()), static_cast<int>(at.y())},
               static_cast<int>(zoom * (1 << kShift)), color, cv::FILLED, cv::LINE_AA, kShift);
  }
  return picture;
}

}  // namespace evit::paper
