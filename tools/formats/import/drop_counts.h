#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "common/evaluation/trajectory.h"
#include "common/time/utime.h"

namespace evit::formats {

/// What was left out of one stream, and why.
struct DropCounts {
  std::int64_t disorder = 0;  // earlier than the one before
  std::int64_t invalid = 0;   // NaN, infinite or, of a pose, no rotation
  std::int64_t outside = 0;   // pixel not on the sensor

  std::int64_t total() const { return disorder + invalid + outside; }
};

/// "12 events dropped: 3 earlier than the one before, 9 outside the sensor"; empty where nothing was.
std::string DropText(const DropCounts& dropped, const std::string& what);

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

/// Appends a sample or pose that is finite and later than the last one, counts the others.
template <typename List, typename Item>
void AppendValid(const Item& item, bool valid, List* list, DropCounts* dropped) {
  if (!valid) {
    ++dropped->invalid;
  } else if (!list->empty() && item.t <= list->back().t) {
    ++dropped->disorder;
  } else {
    list->push_back(item);
  }
}

/// The same for a pose as it was read: its quaternion is made of length 1, or is none.
void AppendPose(StampedPose pose, bool finite, Trajectory* truth, DropCounts* dropped);

}  // namespace evit::formats
