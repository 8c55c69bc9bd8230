#pragma once

#include <string>
#include <utility>

namespace evit {

/// Names of all channels, with an optional prefix so that several pipelines share a bus.
/// docs/reference/channels.md says who sends what, and a test keeps it true to this list.
struct Channels {
  explicit Channels(std::string prefix_of_all = "") : prefix(std::move(prefix_of_all)) {}

  std::string prefix;
  std::string events = prefix + "EVENTS";
  std::string imu = prefix + "IMU";
  std::string ground_truth = prefix + "GROUND_TRUTH";
  std::string keyframe = prefix + "KEYFRAME";
  std::string map_query = prefix + "MAP_QUERY";
  std::string map_points = prefix + "MAP_POINTS";
  std::string place_query = prefix + "PLACE_QUERY";
  std::string places = prefix + "PLACES";
  std::string place_prior = prefix + "PLACE_PRIOR";
  std::string window_state = prefix + "WINDOW_STATE";
  std::string body_pose = prefix + "BODY_POSE";
  std::string tracker_mode = prefix + "TRACKER_MODE";
  std::string status = prefix + "STATUS";
  std::string replay_control = prefix + "REPLAY_CONTROL";
  std::string credit = prefix + "CREDIT";
  std::string stream_end = prefix + "STREAM_END";
  std::string pose_hint = prefix + "POSE_HINT";
  std::string view_query = prefix + "VIEW_QUERY";
  std::string map_view = prefix + "MAP_VIEW";
};

}  // namespace evit
