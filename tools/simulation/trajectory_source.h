#pragma once

#include <cstdint>
#include <string>

#include "common/geometry/rig.h"
#include "tools/simulation/pose_spline.h"
#include "tools/simulation/scene.h"
#include "tools/simulation/tremor.h"

namespace evit::simulation {

/// What the poses of a trajectory file are.
enum class TrajectoryFrame {
  kAuto,
  kBody,       // T_map_body, world z up
  kMarkerYUp,  // motion-capture marker body, world y up (VECtor's raw OptiTrack poses)
};

struct TrajectorySettings {
  std::string source;  // TUM file or "builtin:NAME", see BuiltinMotionNames()
  TrajectoryFrame frame = TrajectoryFrame::kAuto;
  double begin_s = 0, end_s = 0;  // part of the file, from its first stamp; end_s <= begin_s: to its end
  double duration_s = 12;         // builtin: of the sequence, however fast it is played
  double play_speed = 1;          // over 1: the same way in less time
  std::uint64_t variant = 1;      // builtin: another motion of the same kind for each
  Tremor tremor;                  // on top of the motion
  std::uint64_t tremor_seed = 1;
  double knot_ms = 33;  // spacing of the spline's knots
};

struct Motion {
  PoseSpline spline;                      // T_map_body
  Utime begin = 0, end = 0;               // the part to simulate, within the spline
  std::string name;                       // of the sequence: the file's stem, or the builtin's
  bool at_desk = false;                   // placed before the room's desk, not in its middle
  std::string note;                       // how the source was read, for the log
  double fit_rms_m = 0, fit_rms_deg = 0;  // poses against the spline, before any tremor
};

/// Reads or makes a motion and smooths it. Throws std::runtime_error: unreadable or unordered file, unknown
/// builtin, clip outside the file or shorter than 0.5 s, settings out of range.
Motion LoadMotion(const TrajectorySettings& settings, const Rig& rig);

/// Puts the motion into the room: turned about z so that the camera looks towards +x on average, the middle
/// of the camera's path in the middle of the free space; or, at_desk, some metre before the desk and facing
/// it. Throws std::runtime_error where it does not fit.
void PlaceInRoom(const Rig& rig, const Scene& scene, Motion* motion);

/// How fast the camera moves (m/s) and turns (rad/s): mean and 99th percentile over time.
struct MotionSpeed {
  double mean = 0, p99 = 0, turn_mean = 0, turn_p99 = 0;
};
MotionSpeed MeasureMotionSpeed(const Motion& motion, const Rig& rig);

}  // namespace evit::simulation
