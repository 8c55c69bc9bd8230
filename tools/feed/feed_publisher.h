#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "common/bus/channels.h"
#include "tools/feed/feed_records.h"

namespace evit::feed {

struct FeedOptions {
  int width = 0, height = 0;  // pixels; 0: whatever comes
  Utime imu_offset = 0;       // us to add to IMU stamps to get the clock of the events
  bool align_clocks = false;  // find that offset from when the data arrive
};

struct FeedCounts {
  std::int64_t events = 0, packets = 0, imu = 0;
  std::int64_t late = 0;     // earlier than what has been sent
  std::int64_t outside = 0;  // pixel not on the sensor
  std::int64_t invalid = 0;  // not finite
  Utime imu_offset = 0;      // in force
};

/// Makes EVENTS and IMU of a live stream: packets of at most 7,000 events and 5 ms, "none until here" where
/// the camera is silent, IMU samples one by one. Knows no time but that of the data and of the arrivals that
/// it is told.
class FeedPublisher {
 public:
  /// Sends one message: data time (us), channel, bytes.
  using Send = std::function<void(Utime, const std::string&, const std::vector<std::uint8_t>&)>;

  FeedPublisher(const FeedOptions& options, const Channels& channels, std::int64_t epoch, Send send);

  /// Data that have arrived at `now` (us, host's clock).
  void Add(const EventArray& events, const std::vector<ImuSample>& imu, Utime now);
  /// Sends events that wait for their packet to fill: the input has paused.
  void Flush();
  /// What is held back for the alignment of clocks too: the input has ended.
  void Close();
  const FeedCounts& counts() const { return counts_; }

 private:
  void AddEvent(Utime t, std::uint16_t x, std::uint16_t y, std::uint8_t p);
  void SendImu(ImuSample sample);
  void Align(const EventArray& events, const std::vector<ImuSample>& imu, Utime now);

  static constexpr Utime kNever = std::numeric_limits<Utime>::min();

  FeedOptions options_;
  Channels channels_;
  std::int64_t epoch_;
  Send send_;
  FeedCounts counts_;
  EventArray packet_;
  Utime last_event_ = kNever, last_imu_ = kNever, known_ = kNever;  // stamps; events are sent up to known_
  // Alignment: the smallest delays of arrival seen (us), and what waits for it.
  bool aligned_ = true;
  Utime aligning_since_ = kNever, event_delay_ = 0, imu_delay_ = 0;
  std::vector<ImuSample> held_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace evit::feed
