#include "common/events/feedback_schedule.h"

namespace evit {

void FeedbackSchedule::Set(std::int64_t seq, const TrackerFeedback& feedback) {
  newest_ = feedback;
  if (lossless_ && seq >= first_) answers_[seq] = feedback;
}

const TrackerFeedback* FeedbackSchedule::For(std::int64_t seq) const {
  if (!lossless_) return &newest_;
  if (seq < kDelay) return &default_;
  const auto found = answers_.find(seq - kDelay);
  return found == answers_.end() ? nullptr : &found->second;
}

void FeedbackSchedule::ForgetBefore(std::int64_t seq) {
  first_ = seq - kDelay;
  answers_.erase(answers_.begin(), answers_.lower_bound(first_));
}

}  // namespace evit
