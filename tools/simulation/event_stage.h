#pragma once

#include <functional>

#include "common/events/event.h"
#include "tools/simulation/event_sensor.h"
#include "tools/simulation/light.h"
#include "tools/simulation/moving_box.h"
#include "tools/simulation/render_schedule.h"
#include "tools/simulation/renderer.h"

namespace evit::simulation {

struct EventCounts {
  std::size_t positive = 0, negative = 0, noise = 0;  // noise: part of the other two
  double peak_rate = 0;                               // events/s, most in any 10 ms
  std::size_t total() const { return positive + negative; }
};

/// What a map knows nothing of.
struct Disturbances {
  Lamp lamp;
  Cover cover;
  const MovingBox* box = nullptr;  // none where null
};

/// Renders along the schedule and lets the sensor's events come out in order of time, in portions of some
/// milliseconds. Bit-identical for any number of threads. `progress`: 0..1.
EventCounts SimulateEvents(const Renderer& renderer, const PoseSpline& motion, const Rig& rig,
                           const RenderSchedule& schedule, const Disturbances& disturbances,
                           const EventSensorSettings& settings, std::uint64_t seed, int threads,
                           const std::function<void(const EventArray&)>& sink,
                           const std::function<void(double)>& progress);

}  // namespace evit::simulation
