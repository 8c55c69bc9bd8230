#pragma once

#include <cstdint>
#include <map>

#include "common/events/tracker_feedback.h"

namespace evit {

/// Which of the tracker's answers each keyframe is made with.
///
/// Lossless: keyframe k with the answer to keyframe k-2 (k < 2: defaults), so that the same data give the
/// same keyframes; real time: the newest answer.
class FeedbackSchedule {
 public:
  static constexpr std::int64_t kDelay = 2;  // keyframes

  explicit FeedbackSchedule(bool lossless) : lossless_(lossless) {}

  /// The answer to keyframe `seq`.
  void Set(std::int64_t seq, const TrackerFeedback& feedback);
  /// What keyframe `seq` is made with; null where that is still to come.
  const TrackerFeedback* For(std::int64_t seq) const;
  /// No keyframe before `seq` will be made any more.
  void ForgetBefore(std::int64_t seq);

 private:
  bool lossless_;
  std::int64_t first_ = -kDelay;  // answers before are of no use
  TrackerFeedback default_, newest_;
  std::map<std::int64_t, TrackerFeedback> answers_;
};

}  // namespace evit
