#pragma once

#include <chrono>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"

namespace evit {

/// Notes when poses come (WINDOW_STATE while tracking), to tell how long they were missing.
class Outages {
 public:
  using Clock = std::chrono::steady_clock;

  /// `bus` must outlive this.
  Outages(Bus* bus, const Channels& channels);

  /// Ms from `since` to the end of the longest time without a pose that ends within two seconds after it, or
  /// before `until` where that is earlier. Where no pose came any more: up to the end of that time.
  double MsAfter(Clock::time_point since, Clock::time_point until) const;

  void Add(Clock::time_point at) { arrivals_.push_back(at); }

 private:
  std::vector<Clock::time_point> arrivals_;
};

}  // namespace evit
