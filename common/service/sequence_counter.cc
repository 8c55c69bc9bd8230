#include "common/service/sequence_counter.h"

namespace evit {

SequenceCounter::SequenceCounter(StatusReporter* status, const std::string& channel)
    : received_(&status->Counter(channel + ".received")),
      lost_(&status->Counter(channel + ".lost")),
      duplicate_(&status->Counter(channel + ".duplicate")),
      restarts_(&status->Counter(channel + ".restarts")),
      invalid_(&status->Counter(channel + ".invalid")) {}

SequenceCounter::Verdict SequenceCounter::Classify(std::int64_t epoch, std::int64_t seq) const {
  if (!heard_ || epoch != epoch_) return Verdict::kNewEpoch;
  if (seq == next_) return Verdict::kNext;
  return seq > next_ ? Verdict::kGap : Verdict::kOld;
}

SequenceCounter::Verdict SequenceCounter::Commit(std::int64_t epoch, std::int64_t seq) {
  const Verdict verdict = Classify(epoch, seq);
  switch (verdict) {
    case Verdict::kOld:
      ++*duplicate_;
      return verdict;
    case Verdict::kNewEpoch:
      // Joining a running stream late is not a loss, so messages before the first one heard do not count.
      if (heard_) ++*restarts_;
      heard_ = true;
      epoch_ = epoch;
      break;
    case Verdict::kGap:
      *lost_ += seq - next_;
      break;
    case Verdict::kNext:
      break;
  }
  ++*received_;
  next_ = seq + 1;
  return verdict;
}

void SequenceCounter::CountInvalid() { ++*invalid_; }

}  // namespace evit
