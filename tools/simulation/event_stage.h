#pragma once

#include <functional>

#include "common/events/event.h"
#include "tools/simulation/disturbances.h"
#include "tools/simulation/event_counts.h"
#include "tools/simulation/event_sensor.h"
#include "tools/simulation/optics.h"
#include "tools/simulation/readout.h"
#include "tools/simulation/render_schedule.h"
#include "tools/simulation/renderer.h"

namespace evit::simulation {

/// From the light to the file.
struct CameraSettings {
  OpticsSettings optics;
  EventSensorSettings sensor;
  ReadoutSettings readout;
};

/// Renders along the schedule and lets the sensor's events come out in order of time, in portions of some
/// milliseconds. Bit-identical for any number of threads. `progress`: 0..1.
EventCounts SimulateEvents(const Renderer& renderer, const PoseSpline& motion, const Rig& rig,
                           const RenderSchedule& schedule, const Disturbances& disturbances,
                           const CameraSettings& settings, std::uint64_t seed, int threads,
                           const std::function<void(const EventArray&)>& sink,
                           const std::function<void(double)>& progress);

}  // namespace evit::simulation
