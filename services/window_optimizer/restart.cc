// The part of WindowOptimizer that goes on from a checkpoint.
#include <utility>

#include "services/window_optimizer/messages.h"
#include "services/window_optimizer/window_optimizer.h"

namespace evit {
namespace {

constexpr auto kAnnounceAgain = std::chrono::milliseconds(50);
constexpr std::int64_t kStillComing = 12;  // keyframes sent again, or meanwhile, behind the first one

}  // namespace

// Tells frame_builder the last keyframe that was processed, as the answer to it did: it sends those since
// again.
void WindowOptimizer::AnnounceCheckpoint() {
  TrackerOutput output;
  output.mode = checkpoint_->tracking() ? TrackerMode::kTracking : TrackerMode::kBootstrapping;
  output.reason = "restarted: waiting for the keyframes since the checkpoint";
  output.image_speed = checkpoint_->image_speed;
  tracker_mode_t message =
      ToTrackerMode(output, checkpoint_->state, checkpoint_->t, checkpoint_->keyframe_seq);
  message.keyframe_epoch = checkpoint_->keyframe_epoch;
  message.resend = 1;
  Send(channels_.tracker_mode, &message, &mode_seq_);
  announced_ = Clock::now();
}

void WindowOptimizer::CatchUp() {
  const KeyframeCatchUp::Verdict verdict = catch_up_->Look(Clock::now());
  if (verdict == KeyframeCatchUp::Verdict::kWaiting) {
    if (Clock::now() - announced_ > kAnnounceAgain) AnnounceCheckpoint();
    return;
  }
  std::vector<keyframe_t> keyframes = catch_up_->Take();
  catch_up_.reset();
  if (verdict == KeyframeCatchUp::Verdict::kWhole) {
    if (checkpoint_->tracking())
      tracker_.Resume(checkpoint_->t, checkpoint_->state, checkpoint_->information);
    caught_up_ = keyframes.back().seq + kStillComing;
    checkpoint_.reset();
    ++status_.Counter("checkpoint.resumed");
    status_.Counter("checkpoint.keyframes_again") += static_cast<std::int64_t>(keyframes.size());
  }
  for (keyframe_t& keyframe : keyframes) {
    keyframes_.Accept(keyframe.epoch, keyframe.seq);
    Queue(std::move(keyframe));
  }
  ProcessQueue();
}

// Where the keyframes since are gone, at the first one there is: whether it is so near the checkpoint that
// the tracker can start where the body must be now.
bool WindowOptimizer::Resumed() {
  constexpr Utime kLongest = 3'000'000;  // us: beyond that the prediction is worth nothing
  const Checkpoint checkpoint = *std::exchange(checkpoint_, std::nullopt);
  const Utime dt = queue_.front().message.utime - checkpoint.t;
  if (dt < 0 || dt > kLongest) {
    BodyState start;
    start.T_map_body = settings_.T_map_body;
    tracker_.StartFrom(start);
    ++status_.Counter("checkpoint.stale");
  } else {
    tracker_.StartFrom(checkpoint.After(dt));
    ++status_.Counter("checkpoint.used");
  }
  AskForPoints(tracker_.NextQuery());
  return true;
}

}  // namespace evit
