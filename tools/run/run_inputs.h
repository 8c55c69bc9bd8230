#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/evaluation/trajectory.h"
#include "tools/run/run_job.h"

namespace evit::run {

/// What a run starts from, found before anything is started.
struct RunInputs {
  bool has_imu = true;
  Utime log_begin = 0;          // sensor time at which the log begins: 0 of --seconds and of the pictures
  Utime begin = 0, end = 0;     // sensor time of the part that will be played
  std::int64_t n_events = 0;    // in that part
  std::string log_prefix;       // of the log's channels
  std::int64_t lost_bytes = 0;  // of a log that was cut off: what is not played
  std::string settings;         // every value in force, a settings file
  std::optional<SE3> start;     // T_map_body at `begin`; none: to be found
  Trajectory truth;             // of that part; empty: none
};

/// Reads and checks every file of `job`, then makes the folder job.out and removes the results of an earlier
/// run from it. Throws std::runtime_error naming file and remedy; nothing is written then.
RunInputs PrepareRun(const RunJob& job);

}  // namespace evit::run
