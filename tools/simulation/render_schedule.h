#pragma once

#include <vector>

#include "common/geometry/rig.h"
#include "tools/simulation/pose_spline.h"
#include "tools/simulation/scene.h"

namespace evit::simulation {

struct ImageSpeed {
  double mean = 0, median = 0, p95 = 0, max = 0;  // px/s
};

struct RenderSchedule {
  std::vector<Utime> times;  // first and last: of the sequence
  ImageSpeed speed;          // over the whole sequence: of the 95th percentile over the image
  double mean_depth = 0;     // m, over the image and the sequence
};

/// When to render so that, at the image's 95th percentile of speed, the image moves by at most `max_step_px`
/// per step; steps of 0.2 to 5 ms. Image speed comes from pose derivatives and the scene's depth.
RenderSchedule PlanRenders(const PoseSpline& motion, const Rig& rig, const Scene& scene, Utime begin,
                           Utime end, double max_step_px, int threads);

}  // namespace evit::simulation
