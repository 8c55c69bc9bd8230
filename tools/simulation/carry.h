#pragma once

#include "common/evaluation/trajectory.h"

namespace evit::simulation {

/// The body is carried away while nothing can be seen: from `from_s` to `to_s` (of the sequence; equal:
/// never) it moves and turns about the vertical, on top of its motion, and stays where that has brought it.
struct Carry {
  double from_s = 0, to_s = 0;
  double dx = 0, dy = 0;  // m, before the motion is placed in its room
  double yaw = 0;         // rad

  bool any() const { return to_s > from_s; }
};

/// Poses of a sequence that begins at `begin` (us), carried. Smooth to the second derivative.
void CarryAway(const Carry& carry, Utime begin, Trajectory* poses);

}  // namespace evit::simulation
