#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/events/event.h"
#include "common/imu/imu_sample.h"
#include "common/time/utime.h"
#include "tools/run/run_job.h"

namespace evit::run {

/// What the log of a run holds, of the part that is to be played.
struct LogSpan {
  Utime log_begin = 0;       // sensor time, of the whole log
  Utime begin = 0, end = 0;  // sensor time
  std::int64_t n_events = 0;
  std::string prefix;           // of the log's channels
  std::int64_t lost_bytes = 0;  // after the last whole message, where job.tolerate.truncated
  std::vector<ImuSample> imu;   // the first ten seconds, in order of time; empty: there is no IMU
  EventArray events;            // of packets spread over the part: some hundred thousand at most
};

/// Throws std::runtime_error naming the log and the remedy: no EVENTS, cut off (unless
/// job.tolerate.truncated), nothing in the part, two clocks.
LogSpan ReadLogSpan(const RunJob& job);

}  // namespace evit::run
