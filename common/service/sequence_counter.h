#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "common/service/status_reporter.h"

namespace evit {

/// Follows `seq` and `epoch` of one channel and counts CHANNEL.received / .lost / .duplicate / .restarts in
/// STATUS. Tells two things that a sender may do wrong:
/// - CHANNEL.two_senders: an epoch comes again after another: two senders are at work on one channel.
/// - CHANNEL.unnumbered: seq and epoch stay 0. Such messages are all taken as they come; losses cannot be
/// seen.
class SequenceCounter {
 public:
  SequenceCounter(StatusReporter* status, const std::string& channel);

  enum class Verdict {
    kNext,      // exactly the next message
    kGap,       // later than the next: some were lost (or overtaken)
    kOld,       // seen before, or overtaken
    kNewEpoch,  // the sender restarted: all state that came from it is stale
  };
  /// Where the message stands in its stream; changes nothing.
  Verdict Classify(std::int64_t epoch, std::int64_t seq) const;
  /// Classifies and counts the message, which is the newest from here on unless it is old.
  Verdict Commit(std::int64_t epoch, std::int64_t seq);
  /// Counts a message that could not be decoded.
  void CountInvalid();
  /// Whether this epoch came before the current one.
  bool IsOver(std::int64_t epoch) const;
  /// Counts a message of an epoch that is over, which the caller refuses.
  void CountForeign() { ++*two_senders_; }
  /// Whether messages of an epoch that was over have come again: another sender is at work.
  bool two_senders() const { return *two_senders_ >= kSure; }

  std::int64_t next() const { return next_; }
  std::int64_t epoch() const { return epoch_; }

 private:
  std::int64_t* received_;
  std::int64_t* lost_;
  std::int64_t* duplicate_;
  std::int64_t* restarts_;
  std::int64_t* invalid_;
  std::int64_t* two_senders_;
  std::int64_t* unnumbered_;
  bool heard_ = false;
  std::int64_t next_ = 0, epoch_ = -1;
  std::deque<std::int64_t> over_;  // the epochs before

  static constexpr std::int64_t kSure = 3;  // one message of an earlier run may have been under way
};

}  // namespace evit
