#pragma once

#include "common/events/keyframe.h"
#include "common/events/tracker_feedback.h"
#include "evit/keyframe_t.hpp"
#include "evit/tracker_mode_t.hpp"

/// What frame_builder sends, and what it hears of the tracker. Incoming messages must have been checked
/// (DecodeChecked).
namespace evit {

/// All fields but epoch, which is the caller's. Moves the surface out of `keyframe`.
keyframe_t ToMessage(Keyframe keyframe);

TrackerFeedback ToFeedback(const tracker_mode_t& message);

}  // namespace evit
