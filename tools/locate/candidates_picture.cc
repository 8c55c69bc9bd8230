#include "tools/locate/candidates_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "common/text/format_text.h"
#include "tools/pictures/write_picture.h"

namespace evit::locate {
namespace {

constexpr int kMapPoints = 6000;

cv::Mat Panel(const cv::Mat& surface, const MapIndex& map, const Rig& rig, const PlaceCandidate& candidate) {
  cv::Mat panel;
  cv::cvtColor(surface, panel, cv::COLOR_GRAY2BGR);
  VisibilityQuery query;
  query.T_map_camera = candidate.T_map_body * rig.T_body_camera;
  query.camera = rig.camera;
  query.max_points = kMapPoints;
  const SE3 T_camera_map = query.T_map_camera.Inverse();
  for (const std::int32_t id : map.Query(query).ids) {
    Eigen::Vector2d at;
    const Eigen::Vector3d point = map.map().points[id].cast<double>();
    if (!rig.camera.Project(T_camera_map * point, &at) || !rig.camera.Contains(at)) continue;
    panel.at<cv::Vec3b>(static_cast<int>(std::lround(at.y())), static_cast<int>(std::lround(at.x()))) = {
        40, 40, 230};
  }
  const Eigen::Vector3d& p = candidate.T_map_body.p;
  const std::string text =
      FormatText("%.2f %.2f %.2f  significance %.1f", p.x(), p.y(), p.z(), candidate.significance);
  cv::putText(panel, text, {8, panel.rows - 10}, cv::FONT_HERSHEY_SIMPLEX, 0.45, {0, 0, 0}, 1, cv::LINE_AA);
  return panel;
}

}  // namespace

void WriteCandidates(const std::string& path, const cv::Mat& surface, const MapIndex& map, const Rig& rig,
                     const std::vector<PlaceCandidate>& candidates, std::size_t count) {
  std::vector<cv::Mat> panels;
  for (std::size_t k = 0; k < std::min(count, candidates.size()); ++k)
    panels.push_back(Panel(surface, map, rig, candidates[k]));
  cv::Mat picture;
  cv::hconcat(panels, picture);
  pictures::WritePicture(path, picture);
}

}  // namespace evit::locate
