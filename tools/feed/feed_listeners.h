#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "common/bus/bus.h"

namespace evit::feed {

/// Whether anybody hears what `evit feed` sends: a frame_builder says its STATUS once a second.
class FeedListeners {
 public:
  /// On a connection of its own to the bus `url`, with the channels' `prefix`.
  FeedListeners(const std::string& url, const std::string& prefix);

  /// Call now and then. Warns on stderr, once, where none has been heard for 3 s.
  void Tick();
  /// At the end: waits until those 3 s are over, where they are not, and warns if nobody was there.
  void Finish();

 private:
  using Clock = std::chrono::steady_clock;
  std::unique_ptr<Bus> bus_;
  Clock::time_point begin_ = Clock::now();
  bool heard_ = false, warned_ = false;
};

}  // namespace evit::feed
