#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "common/service/status_reporter.h"
#include "common/wire/event_decoder.h"
#include "services/log_replay/position.h"
#include "services/log_replay/recording.h"

namespace evit {

/// Puts a recording's messages on the bus: checks them, drops and counts what is invalid or goes back in time
/// (EVENTS.invalid, EVENTS.out_of_order ...), and stamps them with this run's epoch and numbers without gaps.
class StreamSender {
 public:
  /// All must outlive this.
  StreamSender(Bus* bus, const Channels& channels, const Recording* recording, StatusReporter* status);

  /// A new stream: seq from 0, no memory of earlier times.
  void Restart(std::int64_t epoch);
  /// The stream of an earlier process, as if it had never ended.
  void Continue(const ReplayPosition& position);
  /// Puts its own share into `position`.
  void Save(ReplayPosition* position) const;

  /// Sends message `i` of the recording as the next of its stream. False where it was dropped.
  bool SendNew(std::size_t i);
  /// Sends message `i` again under the number it had.
  void SendAgain(std::size_t i, std::int64_t seq);

  /// Messages sent so far in this stream, which is also the next seq.
  std::int64_t sent(Recording::Kind kind) const { return next_[kind]; }
  std::int64_t epoch() const { return epoch_; }
  /// Sensor time of the last event, sample or pose sent in this stream, us; `otherwise` where nothing was.
  std::int64_t last_utime(std::int64_t otherwise) const;

 private:
  struct Span {
    std::int64_t begin = 0, end = 0;  // us, sensor clock, of the first and the last item
  };
  bool Decode(Recording::Kind kind, Span* span);
  void Publish(Recording::Kind kind, std::int64_t seq);

  Bus* bus_;
  const Recording* recording_;
  std::array<std::string, 3> channels_;
  std::array<std::int64_t*, 3> sent_counter_{}, invalid_{}, out_of_order_{};
  std::array<std::int64_t, 3> next_{}, last_utime_{};
  std::int64_t epoch_ = 0;
  std::vector<std::uint8_t> bytes_;
  EventPacket events_;
  imu_batch_t imu_;
  body_pose_t pose_;
};

}  // namespace evit
