#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "evit/credit_t.hpp"

namespace evit {

/// The sender's side of lossless replay: which messages are under way, whether more may be sent, what to send
/// again. Go-back-N on bytes: at most `limit` bytes are ahead of the slowest consumer. Without progress for a
/// while everything unacknowledged counts as lost and is sent again from the first, at first one message
/// only: where the consumer was just slow, that probe costs little and the next credit takes the rest back.
/// No bus, no clock: times are arguments.
class SendWindow {
 public:
  enum Stream { kEvents = 0, kImu = 1 };
  struct Item {
    Stream stream;
    std::int64_t seq;    // in its stream
    std::int64_t bytes;  // on the wire
    std::size_t source;  // the caller's: where to read it again
  };
  enum class Verdict {
    kTaken,
    kNotAwaited,  // from a consumer nobody waits for
    kImpossible,  // acknowledges what was never sent
    kRestarted,   // the consumer restarted and lacks what it had: begin a new stream at
                  // first_unacknowledged()
  };

  SendWindow(const std::vector<std::string>& consumers, std::int64_t limit_bytes,
             std::int64_t timeout_us = 200'000);

  /// Forgets what is under way: a new stream, seq from 0. Consumers stay known.
  void Restart(std::int64_t stream_epoch);

  Verdict OnCredit(const credit_t& credit, std::int64_t now_us);

  /// Consumers that have not been heard yet.
  std::vector<std::string> missing_consumers() const;
  /// Us since the consumer heard least recently was heard; 0 where all are missing or none is awaited.
  std::int64_t longest_silence(std::int64_t now_us) const;

  /// Whether `bytes` more may go out now. One message always may when nothing is under way.
  bool MaySend(std::int64_t bytes) const;
  /// A new message went out.
  void Sent(const Item& item, std::int64_t now_us);

  /// The message to send again next; null where there is none. Comes before anything new.
  const Item* NextAgain() const;
  void SentAgain();

  /// Nothing has moved for the time-out: call often, and then GoBack.
  bool Stalled(std::int64_t now_us) const;
  /// Everything under way counts as lost, and the time-out doubles, up to a second, until something moves.
  void GoBack(std::int64_t now_us);

  bool all_acknowledged() const { return items_.empty(); }
  /// Source of the first message not acknowledged by all; `otherwise` where there is none.
  std::size_t first_unacknowledged(std::size_t otherwise) const {
    return items_.empty() ? otherwise : items_.front().source;
  }
  std::int64_t bytes_under_way() const { return under_way_; }

 private:
  struct Consumer {
    bool heard = false;
    std::int64_t epoch = 0;
    std::int64_t heard_us = 0;
    std::array<std::int64_t, 2> next = {0, 0};  // -1: does not consume this stream
  };
  bool Acknowledged(const Item& item) const;
  void Release(std::int64_t now_us);

  std::map<std::string, Consumer> consumers_;
  std::int64_t limit_;
  std::int64_t timeout_us_;
  std::int64_t stream_epoch_ = -1;
  std::array<std::int64_t, 2> sent_ = {0, 0};  // seq of the next new message of each stream
  std::deque<Item> items_;                     // not acknowledged by all
  std::size_t cursor_ = 0;      // items before it are under way, from it on they wait to be sent again
  std::int64_t under_way_ = 0;  // bytes of the items before the cursor
  std::int64_t moved_us_ = 0;
  std::int64_t patience_us_ = 0;
  bool probing_ = false;
};

}  // namespace evit
