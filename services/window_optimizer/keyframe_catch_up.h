#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <vector>

#include "evit/keyframe_t.hpp"

namespace evit {

/// After a restart: collects the keyframes that frame_builder still holds and sends again, and those that
/// come live meanwhile, until there is no hole between the last one processed before the restart and the
/// newest.
class KeyframeCatchUp {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr auto kPatience = std::chrono::milliseconds(250);

  /// The last keyframe processed.
  KeyframeCatchUp(std::int64_t epoch, std::int64_t seq) : epoch_(epoch), seq_(seq) {}

  void Add(keyframe_t message, Clock::time_point now);

  enum class Progress {
    kWaiting,  // for more
    kWhole,    // Take() gives every keyframe since
    kHopeless  // frame_builder is another one, or does not have them any more
  };
  Progress ProgressAt(Clock::time_point now) const;

  /// Those after the last one processed, in order.
  std::vector<keyframe_t> Take();

 private:
  std::int64_t epoch_, seq_;
  std::map<std::int64_t, keyframe_t> held_;
  bool other_epoch_ = false;
  Clock::time_point moved_;  // when the first one came, or the last one that was missing
};

}  // namespace evit
