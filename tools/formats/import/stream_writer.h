#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/bus/channels.h"
#include "common/bus/log_file.h"
#include "common/evaluation/trajectory.h"
#include "common/events/event.h"
#include "common/imu/imu_sample.h"

namespace evit::formats {

/// Writes events, IMU samples and ground truth as one log in order of data time. Samples and truth are known
/// from the start; events come in pieces.
class StreamWriter {
 public:
  StreamWriter(const std::string& path, std::int64_t epoch, std::vector<ImuSample> imu, Trajectory truth);

  void AddEvent(Utime t, std::uint16_t x, std::uint16_t y, std::uint8_t polarity);
  /// The same for events [begin, end) of an array, sorted by time.
  void AddEvents(const EventArray& events, std::size_t begin, std::size_t end);
  /// Writes what is left, up to time `end`. At least one event has been added.
  void Close(Utime end);

  std::int64_t n_packets() const { return n_packets_; }

 private:
  void FlushPacket();
  void WriteWatermark(Utime t);
  void WriteOthers(Utime until);
  template <typename Message>
  void Write(Utime t, const std::string& channel, const Message& message);

  Channels channels_;
  LogWriter log_;
  std::int64_t epoch_;
  std::vector<ImuSample> imu_;
  Trajectory truth_;
  std::size_t next_imu_ = 0, next_truth_ = 0;
  EventArray packet_;
  std::optional<Utime> known_;  // events are written up to here
  std::int64_t n_packets_ = 0;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace evit::formats
