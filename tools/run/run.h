#pragma once

#include <optional>
#include <string>
#include <utility>

#include "common/geometry/se3.h"

namespace evit::run {

/// One run of the four services on a recorded log.
struct RunJob {
  std::string log, map, rig, config;  // files
  std::string photometric_map;        // the same, for EVPT; `map` may be empty then
  std::string out;                    // folder for the results
  std::string truth;                  // TUM file to score against; empty: none
  std::optional<SE3> initial_pose;    // of the body in the map
  std::string initial_from;           // else: TUM file to take it from, at the start of the log
  bool lossless = true;
  double speed = 1;                                  // real-time mode
  int loops = 1;                                     // real-time mode: played so often
  std::optional<std::pair<double, double>> seconds;  // part of the log
  std::string lcm_url, prefix;
  std::string command;  // for the report
  std::string record;   // log to write KEYFRAME and WINDOW_STATE to; empty: none
};

/// Starts the services, waits for the end and writes trajectory.tum, smoothed.tum, covariance.csv,
/// report.json, trajectory.png and, with truth, consistency.png into `out`. Returns 0 where it tracked to the
/// end, 2 where it was LOST or never tracked. Throws std::runtime_error where it could not run: a file cannot
/// be used, a service died.
int Run(const RunJob& job);

}  // namespace evit::run
