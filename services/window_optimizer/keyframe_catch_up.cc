#include "services/window_optimizer/keyframe_catch_up.h"

#include <utility>

namespace evit {

void KeyframeCatchUp::Add(keyframe_t message, Clock::time_point now) {
  if (held_.empty() && !other_epoch_) moved_ = now;
  if (message.epoch != epoch_) {
    held_.clear();
    epoch_ = message.epoch;
    seq_ = -1;  // all of the newcomer's
    other_epoch_ = true;
  }
  if (message.seq <= seq_) return;
  const std::int64_t newest = held_.empty() ? -1 : held_.rbegin()->first;
  const bool fills_a_hole = message.seq < newest;
  // A keyframe that fills a hole shows that the others are on their way; a duplicate shows nothing.
  if (held_.emplace(message.seq, std::move(message)).second && fills_a_hole) moved_ = now;
}

KeyframeCatchUp::Progress KeyframeCatchUp::ProgressAt(Clock::time_point now) const {
  if (other_epoch_) return Progress::kHopeless;
  if (held_.empty()) return Progress::kWaiting;
  const auto expected = held_.rbegin()->first - seq_;
  if (static_cast<std::int64_t>(held_.size()) == expected) return Progress::kWhole;
  return now - moved_ > kPatience ? Progress::kHopeless : Progress::kWaiting;
}

std::vector<keyframe_t> KeyframeCatchUp::Take() {
  std::vector<keyframe_t> keyframes;
  for (auto& [seq, keyframe] : held_) keyframes.push_back(std::move(keyframe));
  held_.clear();
  return keyframes;
}

}  // namespace evit
