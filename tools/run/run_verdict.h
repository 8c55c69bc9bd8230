#pragma once

#include <string>

#include "common/evaluation/trajectory.h"
#include "tools/run/report.pb.h"

namespace evit::run {

/// What arrived and could not be used for its time.
struct Untimely {
  double events = 0, imu = 0;  // counts
  double imu_share = 0, events_share = 0;
};
/// From frame_builder's counters.
Untimely UntimelyOf(const report::Report& report);

/// Share of the time that was played, s, in which poses came, at most half a second apart.
double TrackedShare(const Trajectory& poses, double seconds);

/// Why the run failed, for a person; empty where it did not. `report` has the final mode and the number
/// of keyframes; `reason` is the tracker's for its mode.
std::string FailureOf(const report::Report& report, const std::string& reason, double tracked_share,
                      const Untimely& untimely);

}  // namespace evit::run
