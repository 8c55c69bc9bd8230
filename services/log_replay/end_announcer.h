#pragma once

#include <cstdint>
#include <string>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "services/log_replay/stream_sender.h"

namespace evit {

/// Says STREAM_END of a stream that is all sent: every 100 ms until half a second after it was delivered, so
/// that one may get lost, then once a second for those who come later. Times in us of the steady clock.
class EndAnnouncer {
 public:
  /// All must outlive this.
  EndAnnouncer(Bus* bus, const Channels& channels, const StreamSender* sender);

  /// A new stream, which has not ended.
  void Restart();
  /// Call often once all is sent. `delivered`: to all that are awaited. `last_utime`: of the recording, us,
  /// where nothing of the stream was fit to be sent.
  void Tick(std::int64_t now_us, bool delivered, std::int64_t last_utime);
  /// Delivered, and said often enough.
  bool Settled(std::int64_t now_us) const;

 private:
  Bus* bus_;
  std::string channel_;
  const StreamSender* sender_;
  std::int64_t seq_ = 0;
  std::int64_t said_us_ = 0;       // the last time; 0: not yet
  std::int64_t delivered_us_ = 0;  // since when everything is with its consumers; 0: it is not yet
};

}  // namespace evit
