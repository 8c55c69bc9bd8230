#include "tools/monitor/camera_mount.h"

#include <algorithm>

namespace evit::monitor {
namespace {

constexpr std::size_t kQueries = 64;  // kept until their estimate comes
constexpr int kLongestMean = 200;     // pairs: predictions err to all sides, by millimetres

}  // namespace

void CameraMount::Set(const Camera& camera, const SE3& T_body_camera) {
  fixed_ = true;
  camera_ = camera;
  T_body_camera_ = T_body_camera;
}

void CameraMount::AddQuery(Utime t, const Camera& camera, const SE3& T_map_camera) {
  if (fixed_) return;
  const bool same = camera_ && camera_->width == camera.width && camera_->height == camera.height &&
                    camera_->fx == camera.fx && camera_->cx == camera.cx;
  if (!same) {
    T_body_camera_.reset();
    n_ = 0;
    queries_.clear();
  }
  camera_ = camera;
  queries_.emplace_back(t, T_map_camera);
  if (queries_.size() > kQueries) queries_.pop_front();
}

void CameraMount::AddEstimate(Utime t, const SE3& T_map_body) {
  const auto query =
      std::find_if(queries_.begin(), queries_.end(), [&](const auto& known) { return known.first == t; });
  if (fixed_ || query == queries_.end()) return;
  const SE3 sample = T_map_body.Inverse() * query->second;
  n_ = std::min(n_ + 1, kLongestMean);
  T_body_camera_ = T_body_camera_ ? Interpolate(*T_body_camera_, sample, 1.0 / n_) : sample;
}

}  // namespace evit::monitor
