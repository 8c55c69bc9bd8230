#pragma once

#include <cstdint>
#include <string>

#include "common/service/status_reporter.h"

namespace evit {

/// Follows `seq` and `epoch` of one channel and counts CHANNEL.received / .lost / .duplicate / .restarts in
/// STATUS.
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

  std::int64_t next() const { return next_; }
  std::int64_t epoch() const { return epoch_; }

 private:
  std::int64_t* received_;
  std::int64_t* lost_;
  std::int64_t* duplicate_;
  std::int64_t* restarts_;
  std::int64_t* invalid_;
  bool heard_ = false;
  std::int64_t next_ = 0, epoch_ = -1;
};

}  // namespace evit
