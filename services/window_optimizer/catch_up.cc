#include "services/window_optimizer/catch_up.h"

#include <utility>

namespace evit {

void KeyframeCatchUp::Add(keyframe_t message, Clock::time_point now) {
  // Each one that fills the hole shows that the others are on their way.
  if ((held_.empty() && !other_epoch_) || (!held_.empty() && message.seq < held_.rbegin()->first))
    moved_ = now;
  if (message.epoch != epoch_) {
    held_.clear();
    epoch_ = message.epoch;
    seq_ = -1;  // all of the newcomer's
    other_epoch_ = true;
  }
  if (message.seq > seq_) held_.emplace(message.seq, std::move(message));
}

KeyframeCatchUp::Verdict KeyframeCatchUp::Look(Clock::time_point now) const {
  if (other_epoch_) return Verdict::kHopeless;
  if (held_.empty()) return Verdict::kWaiting;
  const auto wanted = held_.rbegin()->first - seq_;
  if (static_cast<std::int64_t>(held_.size()) == wanted) return Verdict::kWhole;
  return now - moved_ > kPatience ? Verdict::kHopeless : Verdict::kWaiting;
}

std::vector<keyframe_t> KeyframeCatchUp::Take() {
  std::vector<keyframe_t> keyframes;
  for (auto& [seq, keyframe] : held_) keyframes.push_back(std::move(keyframe));
  held_.clear();
  return keyframes;
}

}  // namespace evit
