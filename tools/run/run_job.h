#pragma once

#include <optional>
#include <string>
#include <utility>

#include "common/geometry/se3.h"

namespace evit::run {

/// How the log is played.
struct Playback {
  bool lossless = true;                              // else in real time
  double speed = 1;                                  // in real time: this many times faster
  int loops = 1;                                     // in real time: played this often
  std::optional<std::pair<double, double>> seconds;  // part of the log
  std::string log_prefix;                            // of the log's channels; empty: found
};

/// What a run continues with, though it looks wrong.
struct Tolerance {
  bool truncated = false;  // a log that was cut off: what is whole of it is played
  bool any_imu = false;    // an IMU whose units or axes look wrong
  bool any_rig = false;    // extrinsics that look inverted
  bool no_score = true;    // a truth with too few poses for a score
};

/// What is known of the place, where there is no start pose: texts of ParsePlacePrior().
struct PlaceTexts {
  std::string near, height, yaw;
};

/// One run of the four services on a recorded log.
struct RunJob {
  std::string log, map, rig, config;  // files
  std::string photometric_map;        // the same, for EVPT; `map` may be empty then
  std::string out;                    // folder for the results
  std::string truth;                  // TUM file to score against; empty: none
  std::optional<SE3> initial_pose;    // of the body in the map
  std::string
      initial_from;  // else: TUM file to take it from, at the start of the log; neither: it is looked for
  PlaceTexts place;
  Playback play;
  Tolerance tolerate;
  std::string lcm_url, prefix;
  std::string command;  // for the report
  std::string record;   // log to write KEYFRAME and WINDOW_STATE to; empty: none
};

}  // namespace evit::run
