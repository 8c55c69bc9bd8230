#pragma once

#include <string>

#include "common/evaluation/trajectory.h"
#include "common/geometry/rig.h"

namespace evit::simulation {

/// What the poses of a trajectory file are.
enum class TrajectoryFrame {
  kAuto,
  kBody,       // T_map_body, world z up
  kMarkerYUp,  // motion-capture marker body, world y up (VECtor's raw OptiTrack poses)
};

/// Makes T_map_body, z up, of whatever the file holds. kAuto: chosen by how much the poses look like a camera
/// held by hand. Returns how the poses were read, for people.
std::string ConvertToBody(TrajectoryFrame frame, const Rig& rig, Trajectory* poses);

}  // namespace evit::simulation
