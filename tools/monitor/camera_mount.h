#pragma once

#include <deque>
#include <optional>
#include <utility>

#include "common/geometry/camera.h"
#include "common/geometry/se3.h"
#include "common/time/utime.h"

namespace evit::monitor {

/// Camera and its place on the body. Without a rig file they are learnt from the bus: a query to map_server
/// carries the camera and where it is predicted to be, and the estimate for the same stamp follows.
class CameraMount {
 public:
  /// As a rig file says it; what comes later changes nothing.
  void Set(const Camera& camera, const SE3& T_body_camera);

  /// The camera asked from here, at `t` (us).
  void AddQuery(Utime t, const Camera& camera, const SE3& T_map_camera);
  /// The body was here, while tracking.
  void AddEstimate(Utime t, const SE3& T_map_body);

  const std::optional<Camera>& camera() const { return camera_; }
  /// Nothing while it is not known.
  const std::optional<SE3>& T_body_camera() const { return T_body_camera_; }

 private:
  bool fixed_ = false;
  std::optional<Camera> camera_;
  std::optional<SE3> T_body_camera_;
  int n_ = 0;  // pairs averaged
  std::deque<std::pair<Utime, SE3>> queries_;
};

}  // namespace evit::monitor
