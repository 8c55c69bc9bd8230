#pragma once

#include "common/tracking/tracker_output.h"
#include "services/window_optimizer/keyframe_queue.h"

namespace evit {

/// A keyframe, what the tracker made of it, and how long that took.
struct ProcessedKeyframe {
  QueuedKeyframe keyframe;
  TrackerOutput output;
  double solve_ms = 0;
};

}  // namespace evit
