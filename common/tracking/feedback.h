#pragma once

#include "common/events/tracker_feedback.h"
#include "common/tracking/tracker_output.h"

namespace evit {

/// What the next keyframe depends on, after a tracker's answer to the last one: hand it to
/// KeyframeBuilder::SetFeedbackFor. Its keyframe_stride is 1: overload is the caller's to notice.
TrackerFeedback FeedbackOf(const TrackerOutput& output);

}  // namespace evit
