#pragma once

#include <cstdint>
#include <string>

#include "common/evaluation/trajectory.h"
#include "common/time/time_order.h"

namespace evit::formats {

/// What was left out of one stream, and why.
struct DropCounts {
  std::int64_t late = 0;       // behind others by more than can be sorted, or a repeated sample or pose
  std::int64_t outlier = 0;    // stamp far ahead of those that follow
  std::int64_t invalid = 0;    // NaN, infinite or, of a pose, no rotation
  std::int64_t outside = 0;    // pixel not on the sensor
  std::int64_t unstamped = 0;  // before the stream's first time stamp
  std::int64_t sorted = 0;     // not dropped: moved to their place in time
  bool from_one = false;       // those outside are one column or row too far, and column and row 0 are empty
  bool cut_off = false;        // the file ends within a packet; what is before it was read
  double lost_share = 0;       // of such a file, at least, where it says how long it should be

  std::int64_t total() const { return late + outlier + invalid + outside + unstamped; }
  void Add(const TimeOrderCounts& order) {
    late += order.late;
    outlier += order.outlier;
    sorted += order.sorted;
  }
};

/// "12 events dropped: 3 more than 50 ms late, 9 outside the sensor; 5 sorted"; empty where nothing was.
std::string DropText(const DropCounts& dropped, const std::string& what);

/// Throws std::runtime_error with the counts and a remedy where more than a twentieth was dropped of a stream
/// of which `kept` are left: such a log would look whole and not be.
void RequireMostKept(const std::string& name, const DropCounts& dropped, std::int64_t kept,
                     const std::string& what);

/// Appends a sample or pose that is valid, counts the others. Order and repeated stamps are ImportLog's.
template <typename List, typename Item>
void AppendValid(const Item& item, bool valid, List* list, DropCounts* dropped) {
  if (valid) {
    list->push_back(item);
  } else {
    ++dropped->invalid;
  }
}

/// The same for a pose as it was read: its quaternion is made of length 1, or is none.
void AppendPose(StampedPose pose, bool finite, Trajectory* truth, DropCounts* dropped);

}  // namespace evit::formats
