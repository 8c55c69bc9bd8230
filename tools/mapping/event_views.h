#pragma once

#include <functional>
#include <string>

#include "tools/mapping/event_slices.h"
#include "tools/mapping/frame_reader.h"

namespace evit::mapping {

struct EventReaderOptions {
  EventViewOptions view;
  EventSliceOptions slices;
  double hot_pixel_hz = 150;  // pixels that fire more often, and far more than their neighbours, are left out
  int threads = 2;
};

/// Edges of an event camera's recording, seen from known places. `log`: LCM log with EVENTS; `body`:
/// T_map_body, IMU clock; `poses_path`: where it comes from, for messages; `depth`: m, of the scene. Throws
/// std::runtime_error naming the file and what is wrong: no events, another time, a camera at rest, hardly
/// any edges.
ReadFrames ReadEventViews(const std::string& log, const Trajectory& body, const std::string& poses_path,
                          const Rig& rig, double depth, const EventReaderOptions& options,
                          const std::function<void(double)>& progress);

}  // namespace evit::mapping
