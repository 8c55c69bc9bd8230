#include "services/window_optimizer/keyframe_queue.h"

#include "services/window_optimizer/merge_imu.h"

namespace evit {
namespace {

constexpr std::int64_t kStillComing =
    12;  // keyframes that arrive while those before a restart are worked off

std::pair<std::int64_t, std::int64_t> NumberOf(const keyframe_t& keyframe) {
  return {keyframe.epoch, keyframe.seq};
}

}  // namespace

KeyframeQueue::KeyframeQueue(StatusReporter* status, const Options& options)
    : options_(options), status_(status), counter_(status, "KEYFRAME") {}

// A new sender starts with number 0. Where this service is the newer one, the sender is further on already,
// and what it sends twice is the oldest keyframe it has no answer for.
bool KeyframeQueue::IsNext(const keyframe_t& keyframe) const {
  switch (counter_.Classify(keyframe.epoch, keyframe.seq)) {
    case SequenceCounter::Verdict::kGap:
      return false;
    case SequenceCounter::Verdict::kNewEpoch:
      return keyframe.seq == 0 || rejected_ == NumberOf(keyframe);
    default:
      return true;
  }
}

KeyframeQueue::Admission KeyframeQueue::Admit(keyframe_t keyframe, Clock::time_point now) {
  if (options_.lossless && !IsNext(keyframe)) {
    if (counter_.Classify(keyframe.epoch, keyframe.seq) == SequenceCounter::Verdict::kNewEpoch)
      rejected_ = NumberOf(keyframe);
    ++status_->Counter("KEYFRAME.out_of_order");
    return Admission::kOutOfOrder;
  }
  const SequenceCounter::Verdict verdict = counter_.Commit(keyframe.epoch, keyframe.seq);
  if (verdict == SequenceCounter::Verdict::kOld) return Admission::kOld;
  if (verdict == SequenceCounter::Verdict::kNewEpoch) burst_until_ = -1;
  Push(std::move(keyframe), now);
  return Admission::kQueued;
}

void KeyframeQueue::AdmitCollected(std::vector<keyframe_t> keyframes, Clock::time_point now) {
  for (keyframe_t& keyframe : keyframes) {
    counter_.Commit(keyframe.epoch, keyframe.seq);
    Push(std::move(keyframe), now);
  }
}

void KeyframeQueue::ExpectBurstUpTo(std::int64_t seq) { burst_until_ = seq + kStillComing; }

// High-rate frames come in a burst at the start, and bootstrapping needs each. So do those since the last
// checkpoint after a restart.
bool KeyframeQueue::OldestIsOfABurst() const {
  return !empty() && (front().message.high_rate != 0 || LateByRestart(front().message));
}

void KeyframeQueue::Push(keyframe_t keyframe, Clock::time_point now) {
  const std::size_t room = OldestIsOfABurst() ? options_.burst_capacity : options_.capacity;
  while (!options_.lossless && keyframes_.size() >= room) {
    DropOldest(keyframes_.size() > 1 ? &keyframes_[1].message : &keyframe);
    ++status_->Counter("KEYFRAME.dropped");
  }
  keyframes_.push_back({std::move(keyframe), now});
}

void KeyframeQueue::DropOldest(keyframe_t* next) {
  if (options_.merge_imu) MergeImu(front().message, next);
  keyframes_.pop_front();
}

void KeyframeQueue::DropSuperseded() {
  while (!options_.lossless && keyframes_.size() > 1 && front().message.high_rate != 0) {
    DropOldest(&keyframes_[1].message);
    ++status_->Counter("KEYFRAME.superseded");
  }
}

QueuedKeyframe KeyframeQueue::Pop() {
  QueuedKeyframe next = std::move(keyframes_.front());
  keyframes_.pop_front();
  return next;
}

}  // namespace evit
