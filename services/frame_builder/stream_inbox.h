#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <variant>

#include "common/service/sequence_counter.h"
#include "common/wire/event_decoder.h"
#include "evit/imu_batch_t.hpp"
#include "evit/stream_end_t.hpp"

namespace evit {

/// Arrived messages of the two recorded streams in the order they are to be used, and what of them has been
/// taken out: lossless replay is told the latter (CREDIT), so data that waits here holds it back.
///
/// Lossless: exactly the next message of each stream is admitted. Real time: whatever is not old.
class StreamInbox {
 public:
  using Message = std::variant<EventPacket, imu_batch_t>;
  struct Item {
    Message message;
    std::size_t bytes;
  };

  StreamInbox(StatusReporter* status, bool lossless);

  enum class Verdict { kTaken, kRefused, kNewStream };
  /// kNewStream: taken, and it is the first of a new run of the sender: what came before is stale, and what
  /// waited here of it has been dropped.
  Verdict Put(EventPacket message, std::size_t bytes);
  Verdict Put(imu_batch_t message, std::size_t bytes);
  void CountInvalidEvents() { events_.CountInvalid(); }
  void CountInvalidImu() { imu_.CountInvalid(); }

  std::optional<Item> Take();
  /// Messages that wait.
  std::size_t size() const { return items_.size(); }

  /// The sender says its streams have ended.
  void End(const stream_end_t& end);
  /// All of a stream that has ended has been taken (real time: all that came).
  bool ended() const;
  /// Another sender is at work on EVENTS or IMU (SequenceCounter): a lossless run cannot continue.
  bool two_senders() const { return events_.two_senders() || imu_.two_senders(); }

  std::int64_t epoch() const { return epoch_; }  // of the streams; -1: none heard
  std::int64_t taken_events() const { return taken_events_; }
  std::int64_t taken_imu() const { return taken_imu_; }

 private:
  template <typename M>
  Verdict Admit(M message, std::size_t bytes, SequenceCounter* counter);

  StatusReporter* status_;
  bool lossless_;
  SequenceCounter events_, imu_;
  std::int64_t epoch_ = -1;
  std::int64_t taken_events_ = 0, taken_imu_ = 0;  // next message of each to be taken
  std::deque<Item> items_;
  std::optional<stream_end_t> end_;
};

}  // namespace evit
