#pragma once

#include "common/time/utime.h"

namespace evit {

/// What the tracker says, as far as keyframes depend on it (tracker_mode_t).
struct TrackerFeedback {
  enum class Mode { kBootstrapping = 0, kTracking = 1, kLost = 2 };
  Mode mode = Mode::kBootstrapping;
  double image_speed = 0;      // pixels/s; 0: unknown
  Utime useful_interval = 0;   // us: keyframes closer than this tell little; 0: the sooner the better
  double keyframe_stride = 1;  // in overload: so many times more events and samples for each keyframe
};

}  // namespace evit
