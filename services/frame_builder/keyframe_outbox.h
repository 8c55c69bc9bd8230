#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/events/keyframe.h"
#include "common/service/status_reporter.h"
#include "evit/tracker_mode_t.hpp"

namespace evit {

/// Sends KEYFRAME, and holds keyframes to send them again.
///
/// Lossless: all without an answer are held, and sent again while none comes. Real time: the newest are held,
/// for an optimiser that was restarted and lacks them.
class KeyframeOutbox {
 public:
  using Clock = std::chrono::steady_clock;

  /// `bus` and `status` must outlive this. `send_again`: after this without an answer (lossless).
  KeyframeOutbox(Bus* bus, std::string channel, StatusReporter* status, bool lossless,
                 std::chrono::milliseconds send_again);

  void Send(Keyframe keyframe);
  /// The tracker's answer to a keyframe of this outbox.
  void OnAnswer(const tracker_mode_t& answer);
  /// Sends again what is due. Call often.
  void Tick();

  /// -1: none.
  std::int64_t last_sent() const { return last_sent_; }
  /// When the last keyframe was sent, or the last new answer came.
  Clock::time_point last_progress() const { return last_progress_; }

 private:
  struct Sent {
    std::int64_t seq;
    std::vector<std::uint8_t> bytes;
    bool sent;
  };
  void Publish(Sent* sent);
  void SendUnanswered();
  void SendMissing();

  Bus* bus_;
  std::string channel_;
  StatusReporter* status_;
  bool lossless_;
  std::chrono::milliseconds send_again_;
  std::deque<Sent> held_;             // keyframes without an answer; real time: the newest ones
  std::deque<std::int64_t> to_send_;  // numbers of those to send next, first what a restarted optimiser lacks
  std::int64_t last_sent_ = -1, last_answered_ = -1;
  Clock::time_point last_progress_ = Clock::now();
  Clock::time_point sent_again_;
};

}  // namespace evit
