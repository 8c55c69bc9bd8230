#pragma once

#include <cstdint>
#include <string>

#include "tools/simulation/carry.h"
#include "tools/simulation/trajectory_frame.h"
#include "tools/simulation/tremor.h"

namespace evit::simulation {

/// Where a motion comes from and how it is played.
struct MotionSettings {
  std::string source;  // TUM file or "builtin:NAME", see BuiltinMotionNames()
  TrajectoryFrame frame = TrajectoryFrame::kAuto;
  double begin_s = 0, end_s = 0;  // part of the file, from its first stamp; end_s <= begin_s: to its end
  double duration_s = 12;         // builtin: of the sequence, however fast it is played
  double play_speed = 1;          // over 1: the same way in less time
  std::uint64_t variant = 1;      // builtin: another motion of the same kind for each
  Tremor tremor;                  // on top of the motion
  Carry carry;                    // the same
  std::uint64_t tremor_seed = 1;
  double knot_ms = 33;  // spacing of the spline's knots
};

}  // namespace evit::simulation
