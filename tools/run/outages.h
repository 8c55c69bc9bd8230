#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"

namespace evit::run {

/// Notes when poses come (WINDOW_STATE while tracking) and which keyframes were answered (TRACKER_MODE), to
/// tell what a restart cost.
class Outages {
 public:
  using Clock = std::chrono::steady_clock;

  /// `bus` must outlive this.
  Outages(Bus* bus, const Channels& channels);

  /// Ms from `since` to the end of the longest time without a pose that begins within 100 ms after it. Where
  /// no pose came any more: up to `until`, but two seconds at most.
  double MsAfter(Clock::time_point since, Clock::time_point until) const;

  /// Keyframes that nobody answered in that time.
  std::int64_t KeyframesLostAfter(Clock::time_point since, Clock::time_point until) const;

  void Add(Clock::time_point at) { arrivals_.push_back(at); }
  /// window_optimizer's answer to a keyframe.
  void AddAnswer(Clock::time_point at, std::int64_t epoch, std::int64_t seq);

 private:
  struct Hole {
    Clock::time_point at;
    std::int64_t keyframes;
  };
  std::vector<Clock::time_point> arrivals_;
  std::vector<Hole> holes_;
  std::int64_t epoch_ = -1, seq_ = -1;
};

}  // namespace evit::run
