#include "services/window_optimizer/result_publisher.h"

#include <chrono>
#include <string>

#include "common/time/milliseconds.h"
#include "common/wire/tracker_wire.h"

namespace evit {

ResultPublisher::ResultPublisher(Bus* bus, const Channels& channels, StatusReporter* status)
    : status_(status),
      windows_(bus, channels.window_state, status->epoch()),
      modes_(bus, channels.tracker_mode, status->epoch()),
      poses_(bus, channels.body_pose, status->epoch()) {
  last_mode_.keyframe_seq = -1;
}

void ResultPublisher::PublishWindow(const ProcessedKeyframe& processed) {
  status_->AddTiming("solve", processed.solve_ms);
  if (!processed.output.has_pose) return;
  window_state_t window = ToWindowState(processed.output);
  window.lookahead_us = processed.keyframe.message.lookahead_us;
  window.solve_ms = processed.solve_ms;
  window.total_ms = Milliseconds(std::chrono::steady_clock::now() - processed.keyframe.arrived);
  status_->AddTiming("keyframe", window.total_ms);
  windows_.Send(&window);
}

void ResultPublisher::PublishMode(const ProcessedKeyframe& processed, double keyframe_stride) {
  static constexpr const char* kModes[] = {"bootstrapping", "tracking", "lost"};
  const keyframe_t& keyframe = processed.keyframe.message;
  last_mode_ = ToTrackerMode(processed.output, keyframe.utime, keyframe.seq);
  last_mode_.keyframe_epoch = keyframe.epoch;
  last_mode_.keyframe_stride = keyframe_stride;
  modes_.Send(&last_mode_);
  const std::string mode = kModes[static_cast<int>(processed.output.mode)];
  ++status_->Counter("mode." + mode);
  status_->SetState("running", mode + ": " + processed.output.reason);
}

void ResultPublisher::PublishModeAgain() {
  if (has_answered()) modes_.Send(&last_mode_);
}

void ResultPublisher::PublishPose(Utime t, const NavState& state) {
  body_pose_t pose = ToBodyPose(t, state);
  poses_.Send(&pose);
}

}  // namespace evit
