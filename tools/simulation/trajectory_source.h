#pragma once

#include <string>

#include "common/geometry/rig.h"
#include "tools/simulation/pose_spline.h"
#include "tools/simulation/scene.h"

namespace evit {

/// What the poses of a trajectory file are.
enum class TrajectoryFrame {
  kAuto,
  kBody,       // T_world_body, world z up
  kMarkerYUp,  // motion-capture marker body, world y up (VECtor's raw OptiTrack poses)
};

struct TrajectorySettings {
  std::string source;  // TUM file, "builtin:handheld" or "builtin:fast"
  TrajectoryFrame frame = TrajectoryFrame::kAuto;
  double begin_s = 0, end_s = 0;  // part of the file, from its first stamp; end_s <= begin_s: to its end
  double duration_s = 12;         // builtin
  double knot_ms = 33;            // spacing of the spline's knots
};

struct Motion {
  PoseSpline spline;                      // T_world_body
  Utime begin = 0, end = 0;               // the part to simulate, within the spline
  std::string name;                       // of the sequence: the file's stem, or the builtin's
  std::string note;                       // how the source was read, for the log
  double fit_rms_m = 0, fit_rms_deg = 0;  // poses against the spline
};

/// Reads or makes a motion and smooths it. Throws std::runtime_error: unreadable or unordered file, unknown
/// builtin, clip outside the file or shorter than 0.5 s.
Motion LoadMotion(const TrajectorySettings& settings, const Rig& rig);

/// Puts the motion into the room: turned about z so that the camera looks towards +x on average, the middle
/// of the camera's path in the middle of the free space. Throws std::runtime_error where it does not fit.
void PlaceInRoom(const Rig& rig, const Scene& scene, Motion* motion);

}  // namespace evit
