#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/bus/log_file.h"
#include "common/events/event.h"
#include "common/imu/imu_sample.h"

namespace evit::locate {

/// Events and IMU samples of a log, by sensor time.
class RecordedStreams {
 public:
  /// Throws std::runtime_error naming the file: unreadable, or without EVENTS or IMU.
  explicit RecordedStreams(const std::string& path);

  /// us: of the part in which both streams are.
  Utime begin() const { return begin_; }
  Utime end() const { return end_; }

  /// Events of packets that begin in [begin, end).
  EventArray Events(Utime begin, Utime end) const;
  const std::vector<ImuSample>& imu() const { return imu_; }

 private:
  LogReader log_;
  std::vector<std::pair<Utime, std::size_t>> packets_;  // time, and place among the log's entries; in order
  std::vector<ImuSample> imu_;
  Utime begin_ = 0, end_ = 0;
};

}  // namespace evit::locate
