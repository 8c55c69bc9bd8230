#pragma once

#include <string>

#include "tools/run/report.pb.h"

namespace evit::run {

/// What arrived and could not be used for its time.
struct Untimely {
  double events = 0, imu = 0;  // counts
  double imu_share = 0, events_share = 0;
};
/// From frame_builder's counters.
Untimely UntimelyOf(const report::Report& report);

/// Why the run failed, for a person; empty where it did not. `report` has the final mode, the
/// numbers of keyframes and poses, and the coverage; `reason` is the tracker's for its mode.
std::string FailureOf(const report::Report& report, const std::string& reason, const Untimely& untimely);

}  // namespace evit::run
