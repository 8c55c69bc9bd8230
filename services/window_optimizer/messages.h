#pragma once

#include "common/tracking/tracker.h"
#include "evit/body_pose_t.hpp"
#include "evit/keyframe_t.hpp"
#include "evit/map_points_t.hpp"
#include "evit/map_query_t.hpp"
#include "evit/tracker_mode_t.hpp"
#include "evit/window_state_t.hpp"

/// Between what is on the bus and what the tracker takes and gives. All fields of incoming messages are
/// checked before (DecodeChecked); seq and epoch are the caller's.
namespace evit {

/// The input shares no memory with the message.
KeyframeInput FromMessage(const keyframe_t& message);

map_query_t ToMessage(const VisibilityQuery& query);

/// Points of an answer, map frame.
std::vector<Eigen::Vector3f> PointsOf(const map_points_t& message);

/// utime, keyframe_seq, mode, nodes, covariance and figures of the newest keyframe.
window_state_t ToWindowState(const TrackerOutput& output);

/// utime, keyframe_seq, mode, reason and image speed.
tracker_mode_t ToTrackerMode(const TrackerOutput& output, Utime t, std::int64_t keyframe_seq);

body_pose_t ToBodyPose(Utime t, const NavState& state);

}  // namespace evit
