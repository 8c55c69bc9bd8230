#pragma once

#include <string>

namespace evit {

/// Names of all channels, with an optional prefix so that several pipelines share a bus. docs/channels.md
/// says who sends what, and a test keeps it true to this list.
struct Channels {
  explicit Channels(const std::string& prefix = "")
      : events(prefix + "EVENTS"),
        imu(prefix + "IMU"),
        ground_truth(prefix + "GROUND_TRUTH"),
        keyframe(prefix + "KEYFRAME"),
        map_query(prefix + "MAP_QUERY"),
        map_points(prefix + "MAP_POINTS"),
        window_state(prefix + "WINDOW_STATE"),
        body_pose(prefix + "BODY_POSE"),
        tracker_mode(prefix + "TRACKER_MODE"),
        status(prefix + "STATUS"),
        replay_control(prefix + "REPLAY_CONTROL"),
        credit(prefix + "CREDIT"),
        stream_end(prefix + "STREAM_END"),
        pose_hint(prefix + "POSE_HINT"),
        view_query(prefix + "VIEW_QUERY"),
        map_view(prefix + "MAP_VIEW") {}

  std::string events, imu, ground_truth, keyframe, map_query, map_points, window_state, body_pose,
      tracker_mode, status, replay_control, credit, stream_end, pose_hint, view_query, map_view;
};

}  // namespace evit
