#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/tracking/event_alignment.h"
#include "common/tracking/state.h"

namespace evit {

enum class TrackerMode { kBootstrapping = 0, kTracking = 1, kLost = 2 };

struct NodeEstimate {
  Utime t = 0;           // us
  std::int64_t seq = 0;  // keyframe number
  BodyState state;
};

/// What came of one keyframe.
struct TrackerOutput {
  TrackerMode mode = TrackerMode::kBootstrapping;
  std::string reason;                         // why it is in this mode
  bool has_pose = false;                      // nodes.back() is this keyframe
  std::vector<NodeEstimate> nodes;            // the window, oldest first
  Matrix6d covariance = Matrix6d::Zero();     // of the newest pose (pose_covariance.h)
  Matrix15d information = Matrix15d::Zero();  // on the newest state, while tracking
  AlignmentQuality quality;
  int iterations = 0;
  double image_speed = 0;     // pixels/s, 0 where unknown
  Utime useful_interval = 0;  // us: how long the next keyframe may wait (keyframe_need.h)
};

}  // namespace evit
