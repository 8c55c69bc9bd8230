#include "services/window_optimizer/restart_coordinator.h"

#include <utility>

#include "common/wire/tracker_wire.h"

namespace evit {

RestartCoordinator::RestartCoordinator(const std::string& checkpoint_file) {
  if (checkpoint_file.empty()) return;
  file_.emplace(checkpoint_file);
  checkpoint_ = file_->Load();
  if (checkpoint_) catch_up_.emplace(checkpoint_->keyframe_epoch, checkpoint_->keyframe_seq);
}

void RestartCoordinator::Collect(keyframe_t keyframe, Clock::time_point now) {
  catch_up_->Add(std::move(keyframe), now);
}

tracker_mode_t RestartCoordinator::Announce(Clock::time_point now) {
  announced_ = now;
  TrackerOutput output;
  output.mode = checkpoint_->tracking() ? TrackerMode::kTracking : TrackerMode::kBootstrapping;
  output.reason = "restarted: waiting for the keyframes since the checkpoint";
  output.image_speed = checkpoint_->image_speed;
  tracker_mode_t message = ToTrackerMode(output, checkpoint_->t, checkpoint_->keyframe_seq);
  message.keyframe_epoch = checkpoint_->keyframe_epoch;
  message.resend = 1;
  return message;
}

std::vector<keyframe_t> RestartCoordinator::TakeKeyframes() {
  std::vector<keyframe_t> keyframes = catch_up_->Take();
  catch_up_.reset();
  return keyframes;
}

std::optional<BodyState> RestartCoordinator::PredictedAt(Utime t) const {
  const Utime dt = t - checkpoint_->t;
  if (dt < 0 || dt > kLongestPrediction) return std::nullopt;
  return checkpoint_->After(dt);
}

void RestartCoordinator::Done() {
  checkpoint_.reset();
  catch_up_.reset();
}

}  // namespace evit
