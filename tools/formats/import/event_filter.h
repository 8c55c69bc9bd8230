#pragma once

#include <cstdint>
#include <limits>

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
  void CountInvalid() { ++dropped_.invalid; }
  const DropCounts& dropped() const { return dropped_; }

 private:
  int width_, height_;
  Utime last_ = std::numeric_limits<Utime>::min();
  DropCounts dropped_;
};

}  // namespace evit::formats
