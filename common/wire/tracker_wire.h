#pragma once

#include "common/imu/propagation.h"
#include "common/tracking/keyframe_input.h"
#include "common/tracking/tracker_output.h"
#include "evit/body_pose_t.hpp"
#include "evit/keyframe_t.hpp"
#include "evit/tracker_mode_t.hpp"
#include "evit/window_state_t.hpp"

/// What the tracker takes and what it gives, as messages. Incoming messages must have been checked
/// (DecodeChecked); seq and epoch are the caller's.
namespace evit {

/// The input shares no memory with the message.
KeyframeInput FromMessage(const keyframe_t& message);

/// utime, keyframe_seq, mode, nodes, covariance and figures of the newest keyframe.
window_state_t ToWindowState(const TrackerOutput& output);

/// utime, keyframe_seq, mode, reason and image speed.
tracker_mode_t ToTrackerMode(const TrackerOutput& output, Utime t, std::int64_t keyframe_seq);

body_pose_t ToBodyPose(Utime t, const NavState& state);

}  // namespace evit
