#pragma once

#include <cstddef>
#include <string>

#include "common/imu/imu_sample.h"
#include "tools/simulation/event_counts.h"
#include "tools/simulation/motion.h"
#include "tools/simulation/motion_speed.h"
#include "tools/simulation/render_schedule.h"

namespace evit::simulation {

/// What a simulation came to.
struct SimulationSummary {
  std::string name;
  Motion motion;
  MotionSpeed motion_speed;
  double duration_s = 0;
  std::size_t n_renders = 0, n_imu = 0, n_map_points = 0;
  int n_map_views = 0;
  EventCounts events;
  ImageSpeed speed;
  double mean_depth = 0;
  double wall_s = 0;
  ImuBias first_bias, last_bias;
};

}  // namespace evit::simulation
