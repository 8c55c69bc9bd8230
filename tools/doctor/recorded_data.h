#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/bus/log_file.h"
#include "common/events/event.h"
#include "common/imu/imu_sample.h"

namespace evit::doctor {

/// Events and IMU samples of an LCM log as they were recorded, whatever their order; messages that are not
/// well-formed are counted and left out.
class RecordedData {
 public:
  /// Throws std::runtime_error naming the file: unreadable, or neither EVENTS nor IMU in it.
  explicit RecordedData(const std::string& path);

  /// us, the events' clock, of the first and the last message of events; 0 where there is none.
  Utime begin() const { return begin_; }
  Utime end() const { return end_; }
  /// From the first to the last IMU sample; 0 where there is none.
  double imu_seconds() const { return ToSeconds(imu_end_ - imu_begin_); }

  struct Sinks {
    std::function<void(const EventArray&)> events;
    std::function<void(const std::vector<ImuSample>&)> imu;
    std::function<void(double)> progress;  // 0..1
  };
  /// All of the first `seconds` of the log.
  void Read(double seconds, const Sinks& sinks);
  /// Messages that were not well-formed, since the beginning.
  std::int64_t malformed() const { return malformed_; }
  bool truncated() const { return log_.trailing_bytes() > 0; }

 private:
  LogReader log_;
  std::string events_, imu_;  // channels; empty: the log has none
  Utime begin_ = 0, end_ = 0, imu_begin_ = 0, imu_end_ = 0;
  std::int64_t malformed_ = 0;
};

}  // namespace evit::doctor
