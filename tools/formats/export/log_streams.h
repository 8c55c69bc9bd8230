#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/events/event.h"
#include "common/imu/imu_sample.h"

namespace evit::formats {

/// What a log of `evit import` (or of lcm-logger) holds beside the events.
struct LogStreams {
  std::vector<ImuSample> imu;
  Trajectory truth;
  Utime first_event = 0;
  std::int64_t n_events = 0;
  int width = 0, height = 0;  // pixels that all events fit in
};

/// One pass without keeping the events. Throws std::runtime_error naming the file: damaged, cut off (unless
/// allowed), or without events.
LogStreams ScanLog(const std::string& path, bool allow_truncated);

/// Hands out the events, piece by piece, with the share of the log that was read.
void ReadLogEvents(const std::string& path, const std::function<void(const EventArray&, double share)>& take);

}  // namespace evit::formats
