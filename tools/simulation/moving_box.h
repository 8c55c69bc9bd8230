#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/rig.h"
#include "tools/simulation/pose_spline.h"
#include "tools/simulation/scene.h"

namespace evit::simulation {

/// A textured box of 0.4 to 0.6 m that somebody moves to and fro before the camera, at 0.3 to 0.5 m/s: across
/// the middle of what the camera sees on average, beyond the nearest place that the camera comes to. Seeded.
class MovingBox {
 public:
  MovingBox(std::uint64_t seed, const PoseSpline& motion, const Rig& rig, Utime begin, Utime end);
  MovingBox(const MovingBox&) = delete;
  MovingBox& operator=(const MovingBox&) = delete;

  /// Its faces at time t, in the map frame; their textures live as long as this.
  std::vector<Surface> At(Utime t) const;

  /// Of its middle, T_map_box.
  SE3 Pose(Utime t) const;
  const Eigen::Vector3d& size() const { return size_; }

 private:
  Scene box_;  // about its middle
  Eigen::Vector3d size_, centre_, side_;
  Utime begin_;
  double omega_, phase_, bob_phase_, yaw_;
};

}  // namespace evit::simulation
