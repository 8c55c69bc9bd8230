#pragma once

#include <algorithm>
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
    const bool good = x >= 0 && y >= 0 && x < width_ && y < height_;
    extent_.Add(x, y);
    if (!good) ++dropped_.outside;
    return good;
  }
  /// The same for all events of an array, which keeps its good ones. Fast where all are good.
  void Apply(EventArray* events);
  /// 0 or 1; throws std::runtime_error where the numbers that occur have no one meaning.
  std::uint8_t Polarity(std::int64_t value) { return polarity_.Read(value); }
  void CountInvalid(std::int64_t n = 1) { dropped_.invalid += n; }
  /// Also says whether the pixels look as if they were counted from 1.
  DropCounts dropped() const {
    DropCounts dropped = dropped_;
    dropped.from_one = dropped.outside > 0 && extent_.min_x >= 1 && extent_.min_y >= 1 &&
                       extent_.max_x <= width_ && extent_.max_y <= height_;
    return dropped;
  }

 private:
  // Of all pixels, on the sensor or not.
  struct Extent {
    void Add(std::int64_t x, std::int64_t y) {
      min_x = std::min(min_x, x), max_x = std::max(max_x, x);
      min_y = std::min(min_y, y), max_y = std::max(max_y, y);
    }
    std::int64_t min_x = 1 << 16, min_y = 1 << 16, max_x = 0, max_y = 0;
  };

  bool AllGood(const EventArray& events);

  int width_, height_;
  DropCounts dropped_;
  Extent extent_;
  PolarityCode polarity_;
};

}  // namespace evit::formats
