#pragma once

#include <cstdint>
#include <string>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/geometry/se3.h"
#include "evit/replay_control_t.hpp"

namespace evit::run {

/// What a run tells its services: orders to log_replay, and where the body is to window_optimizer.
class Remote {
 public:
  /// `bus` must outlive this.
  Remote(Bus* bus, const Channels& channels);

  void Resume();
  /// Replay continues from the beginning of its part of the log.
  void Rewind();
  /// The body is here (POSE_HINT): tracking restarts from this pose.
  void HintPose(const SE3& T_map_body);

 private:
  void Order(std::int8_t command);

  Bus* bus_;
  Channels channels_;
  std::int64_t epoch_, order_seq_ = 0, hint_seq_ = 0;
};

}  // namespace evit::run
