#pragma once

#include <cstdint>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/imu/propagation.h"
#include "common/service/numbered_sender.h"
#include "common/service/status_reporter.h"
#include "common/tracking/state.h"
#include "evit/body_pose_t.hpp"
#include "evit/tracker_mode_t.hpp"
#include "evit/window_state_t.hpp"
#include "services/window_optimizer/processed_keyframe.h"

namespace evit {

/// Says what came of a keyframe: WINDOW_STATE, BODY_POSE, and TRACKER_MODE, which is also the answer that
/// frame_builder waits for; in STATUS the times "solve" and "keyframe" (ms), the mode and why.
class ResultPublisher {
 public:
  /// `bus` and `status` must outlive this.
  ResultPublisher(Bus* bus, const Channels& channels, StatusReporter* status);

  /// WINDOW_STATE, where the keyframe has a pose.
  void PublishWindow(const ProcessedKeyframe& processed);
  /// TRACKER_MODE. `keyframe_stride`: see tracker_mode_t.
  void PublishMode(const ProcessedKeyframe& processed, double keyframe_stride);
  /// The newest TRACKER_MODE of PublishMode() under a new number, where there is one: the first got lost.
  void PublishModeAgain();
  /// A TRACKER_MODE that answers no keyframe; only seq and epoch are set here.
  void PublishAnnouncement(tracker_mode_t announcement) { modes_.Send(&announcement); }
  /// BODY_POSE at time `t` (us).
  void PublishPose(Utime t, const NavState& state);

  /// PublishMode() has been called.
  bool has_answered() const { return last_mode_.keyframe_seq >= 0; }

 private:
  StatusReporter* status_;
  NumberedSender<window_state_t> windows_;
  NumberedSender<tracker_mode_t> modes_;
  NumberedSender<body_pose_t> poses_;
  tracker_mode_t last_mode_{};
};

}  // namespace evit
