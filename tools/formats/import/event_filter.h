#pragma once

#include <cstdint>
#include <limits>

#include "common/events/event.h"
#include "common/time/utime.h"
#include "tools/formats/import/drop_counts.h"

namespace evit::formats {

/// Keeps the events of a stream that are in order of time and on the sensor, counts the others.
class EventFilter {
 public:
  EventFilter(int width, int height) : width_(width), height_(height) {}

  bool Keep(Utime t, std::int64_t x, std::int64_t y) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return ++dropped_.outside, false;
    if (t < last_) return ++dropped_.disorder, false;
    last_ = t;
    return true;
  }
  /// The same for all events of an array, which keeps its good ones. Fast where all are good.
  void Apply(EventArray* events);
  void CountInvalid(std::int64_t n = 1) { dropped_.invalid += n; }
  const DropCounts& dropped() const { return dropped_; }

 private:
  bool AllGood(const EventArray& events) const;

  int width_, height_;
  Utime last_ = std::numeric_limits<Utime>::min();
  DropCounts dropped_;
};

}  // namespace evit::formats
