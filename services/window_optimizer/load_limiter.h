#pragma once

#include <chrono>

#include "common/service/status_reporter.h"
#include "services/window_optimizer/keyframe_queue.h"
#include "services/window_optimizer/load_governor.h"

namespace evit {

/// Work budget of each keyframe, real time: LoadGovernor's policy applied to the keyframes of a queue.
/// STATUS has the time "wait" (ms) and the counters overload.level and overload.steps.
class LoadLimiter {
 public:
  using Clock = std::chrono::steady_clock;

  struct Limits {
    double point_share;   // 0..1, of the configured points
    double solve_budget;  // s
  };
  /// `status` must outlive this.
  explicit LoadLimiter(StatusReporter* status) : status_(status) {}

  /// For the keyframe that is begun with now. `shows_load`: that it has waited tells how busy the tracker is.
  /// `others_wait`: behind it.
  Limits Begin(const QueuedKeyframe& keyframe, bool shows_load, bool others_wait, Clock::time_point now);

  double keyframe_stride() const { return governor_.keyframe_stride(); }

 private:
  void Observe(double waited_ms);

  StatusReporter* status_;
  LoadGovernor governor_;
  Clock::time_point last_arrived_;  // of the keyframe before
};

}  // namespace evit
