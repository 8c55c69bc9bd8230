#pragma once

#include <cstdint>
#include <string>

#include "common/evaluation/trajectory.h"
#include "common/geometry/rig.h"

namespace evit::simulation {

/// A motion made by formula: sums of sines with random phases, in about 0.15 to 0.75 Hz times `tempo`, scaled
/// to the specified mean speed and turn rate of the camera.
struct BuiltinMotion {
  const char* name;
  std::uint64_t seed;     // of its first variant
  double speed;           // m/s, mean
  double rate;            // rad/s, mean
  double tempo;           // how quick the sines of position are
  double turn_tempo;      // and those of the rotation
  double path_weight[3];  // along the camera's x, y, z at rest: forward, left, up in the map
  double turn_weight[3];  // about the camera's x (pitch), y (yaw), z (roll)
  double pitch_deg;       // of the camera at rest: how far it looks down
  bool at_desk;           // stands before the desk and looks down at it
};

/// The motion of this name; nullptr where there is none. handheld and fast; rotation (nearly pure); and desk,
/// sofa and robot, normal and fast: stand-ins for VECtor's sequences of these names, after their mean speeds
/// and rates.
const BuiltinMotion* FindBuiltinMotion(const std::string& name);

/// "builtin:handheld, builtin:fast, ...", for messages.
std::string BuiltinMotionNames();

/// T_map_body at 200 Hz for `duration` seconds, the camera's path about the origin. `variant` 1 is the motion
/// of that name; others have other phases and frequencies, and are drawn again until their path fits into a
/// room.
Trajectory MakeBuiltinMotion(const BuiltinMotion& builtin, double duration, std::uint64_t variant,
                             const Rig& rig);

}  // namespace evit::simulation
