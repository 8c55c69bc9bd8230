#include "tools/simulation/place_in_room.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace evit::simulation {

namespace {

constexpr double kRightAngle = 0.5 * 3.14159265358979;

void Move(const SE3& T_new_old, Motion* motion) {
  motion->spline = motion->spline.Moved(T_new_old);
  motion->T_map_source = T_new_old * motion->T_map_source;
}

// Moves the path's middle to `centre`, or as near to it as the free space allows.
void Centre(const Eigen::AlignedBox3d& path, const Eigen::AlignedBox3d& free_space, Eigen::Vector3d centre,
            Motion* motion) {
  const Eigen::Vector3d half = 0.5 * path.sizes();
  centre = centre.cwiseMax(free_space.min() + half).cwiseMin(free_space.max() - half);
  Move({Eigen::Quaterniond::Identity(), centre - path.center()}, motion);
}

}  // namespace

void PlaceInRoom(const Rig& rig, const Scene& scene, Motion* motion) {
  constexpr Utime kStep = 20'000;
  Eigen::Vector3d look = Eigen::Vector3d::Zero();
  for (Utime t = motion->begin; t <= motion->end; t += kStep) {
    look += (motion->spline.Pose(t) * rig.T_body_camera).q * Eigen::Vector3d::UnitZ();
  }
  double yaw = std::atan2(look.y(), look.x());
  if (motion->at_desk) yaw -= kRightAngle;  // the desk is towards +y
  Move({ExpSO3(Eigen::Vector3d(0, 0, -yaw)), Eigen::Vector3d::Zero()}, motion);
  Eigen::AlignedBox3d box;
  for (Utime t = motion->begin; t <= motion->end; t += kStep) {
    box.extend((motion->spline.Pose(t) * rig.T_body_camera).p);
  }
  if ((box.sizes().array() > scene.free_space.sizes().array()).any()) {
    std::ostringstream message;
    message << "the camera's path is " << box.sizes().transpose() << " m large; the room has "
            << scene.free_space.sizes().transpose()
            << " m of free space: choose a shorter part with --seconds";
    throw std::runtime_error(message.str());
  }
  if (motion->at_desk) {
    Centre(box, scene.free_space, scene.desk + Eigen::Vector3d(0, -0.75, 0.65), motion);
    return;
  }
  Eigen::Vector3d centre = scene.free_space.center();
  centre.z() = std::clamp(1.35, scene.free_space.min().z() + 0.5 * box.sizes().z(),
                          scene.free_space.max().z() - 0.5 * box.sizes().z());
  Move({Eigen::Quaterniond::Identity(), centre - box.center()}, motion);
}

}  // namespace evit::simulation
