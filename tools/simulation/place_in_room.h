#pragma once

#include "common/geometry/rig.h"
#include "tools/simulation/motion.h"
#include "tools/simulation/scene.h"

namespace evit::simulation {

/// Puts the motion into the room: turned about z so that the camera looks towards +x on average, the middle
/// of the camera's path in the middle of the free space; or, at_desk, some metre before the desk and facing
/// it. Sets T_map_source. Throws std::runtime_error where it does not fit.
void PlaceInRoom(const Rig& rig, const Scene& scene, Motion* motion);

}  // namespace evit::simulation
