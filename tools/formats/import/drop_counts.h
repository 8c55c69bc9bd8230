#pragma once

#include <cstdint>
#include <string>

#include "common/evaluation/trajectory.h"

namespace evit::formats {

/// What was left out of one stream, and why.
struct DropCounts {
  std::int64_t disorder = 0;   // earlier than the one before
  std::int64_t invalid = 0;    // NaN, infinite or, of a pose, no rotation
  std::int64_t outside = 0;    // pixel not on the sensor
  std::int64_t unstamped = 0;  // before the stream's first time stamp

  std::int64_t total() const { return disorder + invalid + outside + unstamped; }
};

/// "12 events dropped: 3 earlier than the one before, 9 outside the sensor"; empty where nothing was.
std::string DropText(const DropCounts& dropped, const std::string& what);

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
