#include "common/service/sequence_counter.h"

#include <algorithm>

namespace evit {
namespace {

constexpr std::size_t kKept = 4;  // epochs that are over

}  // namespace

SequenceCounter::SequenceCounter(StatusReporter* status, const std::string& channel)
    : received_(&status->Counter(channel + ".received")),
      lost_(&status->Counter(channel + ".lost")),
      duplicate_(&status->Counter(channel + ".duplicate")),
      restarts_(&status->Counter(channel + ".restarts")),
      invalid_(&status->Counter(channel + ".invalid")),
      two_senders_(&status->Counter(channel + ".two_senders")),
      unnumbered_(&status->Counter(channel + ".unnumbered")) {}

SequenceCounter::Verdict SequenceCounter::Classify(std::int64_t epoch, std::int64_t seq) const {
  if (!heard_ || epoch != epoch_) return Verdict::kNewEpoch;
  if (seq == next_) return Verdict::kNext;
  // Our own senders' epochs are dates. A driver's 0 is one that was never set.
  if (seq == 0 && next_ == 1 && epoch == 0) return Verdict::kNext;
  return seq > next_ ? Verdict::kGap : Verdict::kOld;
}

SequenceCounter::Verdict SequenceCounter::Commit(std::int64_t epoch, std::int64_t seq) {
  const Verdict verdict = Classify(epoch, seq);
  if (verdict == Verdict::kNext && seq != next_) ++*unnumbered_;
  switch (verdict) {
    case Verdict::kOld:
      ++*duplicate_;
      return verdict;
    case Verdict::kNewEpoch:
      // Joining a running stream late is not a loss, so messages before the first one heard do not count.
      if (heard_) {
        ++*restarts_;
        if (IsOver(epoch)) ++*two_senders_;
        over_.push_back(epoch_);
        if (over_.size() > kKept) over_.pop_front();
      }
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

bool SequenceCounter::IsOver(std::int64_t epoch) const {
  return std::find(over_.begin(), over_.end(), epoch) != over_.end();
}

void SequenceCounter::CountInvalid() { ++*invalid_; }

}  // namespace evit
