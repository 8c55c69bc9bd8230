#pragma once

#include <string>

#include "common/evaluation/trajectory.h"
#include "common/geometry/rig.h"

namespace evit::formats {

enum class TrajectoryFormat { kTum, kKitti, kEuroc, kMcap };

/// Poses of the rig's camera in the frame of the body's poses (T_map_camera), stamped with the camera's
/// clock.
Trajectory CameraTrajectory(const Trajectory& body, const Rig& rig);

/// A trajectory for other people's tools, whole or not at all: TUM text; KITTI (3x4 matrix a line, no
/// stamps); EuRoC's csv (ns, position, quaternion with w first); MCAP with geometry_msgs/PoseStamped of ROS 2
/// on /evit/pose, frame `map`. Throws std::runtime_error naming the file.
void WriteTrajectory(const std::string& path, TrajectoryFormat format, const Trajectory& trajectory);

}  // namespace evit::formats
