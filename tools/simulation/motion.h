#pragma once

#include <string>

#include "common/time/utime.h"
#include "tools/simulation/pose_spline.h"

namespace evit::simulation {

/// A motion to simulate.
struct Motion {
  PoseSpline spline;         // T_map_body
  SE3 T_map_source;          // how the source's poses came into the room: a turn about z, and a move
  Utime begin = 0, end = 0;  // the part to simulate, within the spline
  std::string name;          // of the sequence: the file's stem, or the builtin's
  bool at_desk = false;      // placed before the room's desk, not in its middle
  std::string note;          // how the source was read, for the log
  double fit_rms_m = 0, fit_rms_deg = 0;  // poses against the spline, before any tremor
};

}  // namespace evit::simulation
