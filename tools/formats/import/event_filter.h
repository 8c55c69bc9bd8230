#pragma once

#include <cstdint>

#include "common/events/event.h"
#include "tools/formats/import/drop_counts.h"
#include "tools/formats/import/polarity_code.h"

namespace evit::formats {

/// Keeps the events of a stream that are on the sensor, counts the others. Their order is ImportLog's.
class EventFilter {
 public:
  EventFilter(int width, int height) : width_(width), height_(height) {}

  bool Keep(std::int64_t x, std::int64_t y) {
    if (x >= 0 && y >= 0 && x < width_ && y < height_) return true;
    ++dropped_.outside;
    return false;
  }
  /// The same for all events of an array, which keeps its good ones. Fast where all are good.
  void Apply(EventArray* events);
  /// 0 or 1; throws std::runtime_error where the numbers that occur have no one meaning.
  std::uint8_t Polarity(std::int64_t value) { return polarity_.Read(value); }
  void CountInvalid(std::int64_t n = 1) { dropped_.invalid += n; }
  const DropCounts& dropped() const { return dropped_; }

 private:
  bool AllGood(const EventArray& events) const;

  int width_, height_;
  DropCounts dropped_;
  PolarityCode polarity_;
};

}  // namespace evit::formats
