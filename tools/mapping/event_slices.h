#pragma once

#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/geometry/rig.h"
#include "common/mapping/event_view.h"

namespace evit::mapping {

struct EventSliceOptions {
  double moved_px = 6;     // a slice lasts until the image has moved by so much,
  Utime longest = 80'000;  // us, but no longer,
  double least_px = 1.5;   // and is left out where it has not moved by this then: at rest there are no edges
  std::size_t most = 400;  // of more slices every n-th is taken
};

/// Times of an event camera that each show edges once, from a body's poses (IMU clock): one after the other,
/// as long as things `depth` m away take to move by some pixels. Without events; begin and end are by the
/// events' own clock. None within a hole of the poses.
std::vector<EventSlice> PlanSlices(const Trajectory& body, const Rig& rig, double depth,
                                   const EventSliceOptions& options);

}  // namespace evit::mapping
