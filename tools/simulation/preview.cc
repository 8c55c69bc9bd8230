#include "tools/simulation/preview.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace evit::simulation {
namespace {

constexpr Utime kHalfWindow = 5'000;

}  // namespace

Preview::Preview(const Renderer& renderer, const Rig& rig, const PoseSpline& motion, Utime begin, Utime end,
                 int count, const MovingBox* box)
    : renderer_(renderer), rig_(rig), motion_(motion), box_(box) {
  for (int i = 0; i < count; ++i)
    instants_.push_back({begin + (2 * Utime{i} + 1) * (end - begin) / (2 * Utime{count}), {}});
}

void Preview::Add(const EventArray& events) {
  for (Instant& instant : instants_) {
    const auto begin = std::lower_bound(events.t.begin(), events.t.end(), instant.t - kHalfWindow);
    for (auto i = static_cast<std::size_t>(begin - events.t.begin());
         i < events.size() && events.t[i] <= instant.t + kHalfWindow; ++i) {
      instant.events.push_back(events.t[i], events.x[i], events.y[i], events.p[i]);
    }
  }
}

void Preview::Write(const PointMap& map, const std::function<std::string(const std::string&)>& file) const {
  const Camera& camera = renderer_.camera();
  const cv::Size size(camera.width, camera.height);
  for (std::size_t k = 0; k < instants_.size(); ++k) {
    const SE3 T_map_camera = motion_.Pose(instants_[k].t) * rig_.T_body_camera;
    View view;
    std::vector<Surface> moving;
    if (box_) moving = box_->At(instants_[k].t);
    renderer_.Render(T_map_camera, &view, moving);
    cv::Mat grey, image;
    cv::Mat(size, CV_32F, view.image.data()).convertTo(grey, CV_8U);
    cv::cvtColor(grey, image, cv::COLOR_GRAY2BGR);
    cv::Mat events(size, CV_8UC3, cv::Scalar::all(255));
    const EventArray& list = instants_[k].events;
    for (std::size_t i = 0; i < list.size(); ++i) {
      events.at<cv::Vec3b>(list.y[i], list.x[i]) =
          list.p[i] ? cv::Vec3b(60, 60, 255) : cv::Vec3b(255, 90, 60);
    }
    cv::Mat overlay = events.clone();
    const SE3 T_camera_map = T_map_camera.Inverse();
    for (const Eigen::Vector3f& p : map.points) {
      const Eigen::Vector3d local = T_camera_map * p.cast<double>();
      Eigen::Vector2d pixel;
      if (!camera.Project(local, &pixel) || !camera.Contains(pixel, 1)) continue;
      const int x = static_cast<int>(std::lround(pixel.x())), y = static_cast<int>(std::lround(pixel.y()));
      const float surface = view.inverse_depth[static_cast<std::size_t>(y) * camera.width + x];
      if (local.z() * surface > 1.08) continue;  // hidden
      overlay.at<cv::Vec3b>(y, x) = {0, 150, 0};
    }
    cv::Mat row;
    cv::hconcat(std::vector<cv::Mat>{image, events, overlay}, row);
    char name[40];
    std::snprintf(name, sizeof(name), "preview_%03zu.png", k);
    if (!cv::imwrite(file(name), row)) throw std::runtime_error("cannot write " + file(name));
  }
}

}  // namespace evit::simulation
