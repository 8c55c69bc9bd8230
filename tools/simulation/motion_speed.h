#pragma once

#include "common/geometry/rig.h"
#include "tools/simulation/motion.h"

namespace evit::simulation {

/// How fast the camera moves (m/s) and turns (rad/s): mean and 99th percentile over time.
struct MotionSpeed {
  double mean = 0, p99 = 0, turn_mean = 0, turn_p99 = 0;
};
MotionSpeed MeasureMotionSpeed(const Motion& motion, const Rig& rig);

}  // namespace evit::simulation
