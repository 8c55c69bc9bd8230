#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/se3.h"
#include "evit/keyframe_t.hpp"

namespace evit::monitor {

/// A map point on a keyframe's surface.
struct OverlayPoint {
  float x = 0, y = 0;         // pixels
  std::uint8_t residual = 0;  // surface value there: 0 on an edge with a new event .. 255 where none was
};

/// Projects map points (map frame, m) into a keyframe (TIME_SURFACE) as the tracker does before it compares:
/// at most `limit`, evenly chosen; those outside the image are left out. No point where the camera's size is
/// not the keyframe's.
std::vector<OverlayPoint> ProjectOnto(const keyframe_t& keyframe, const Camera& camera,
                                      const SE3& T_map_camera, const std::vector<Eigen::Vector3f>& points,
                                      std::size_t limit);

}  // namespace evit::monitor
