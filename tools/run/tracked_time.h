#pragma once

#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "tools/run/report.pb.h"

namespace evit::run {

/// A span of sensor time without tracking, after there was some: the tracker was LOST, or it began again
/// (after an IMU gap, for instance). Its end is that of the run where tracking never came back.
struct Untracked {
  Utime begin = 0, end = 0;
  bool lost = false;   // whether LOST was said in it
  std::string reason;  // the tracker's for the first LOST, else for beginning again
};

/// The spans of report.mode_changes(), in order. Where the log was played several times, those of all.
std::vector<Untracked> UntrackedSpans(const report::Report& report);

/// Stamps (us) of the poses that do not follow from the one before: more than half a second later, or with a
/// span without tracking between the two.
std::vector<Utime> BreaksOf(const Trajectory& poses, const std::vector<Untracked>& untracked);

/// The same of a run. `poses`: of the last of `loops` times that the log was played. With several the stamps
/// come again: which of them a span without tracking is of is not told, and none counts.
std::vector<Utime> BreaksOf(const Trajectory& poses, int loops, const report::Report& report);

/// Coverage, the share (0..1) of the time that was played (`seconds`) for which there are poses: what lies
/// between two that follow from each other (BreaksOf).
double Coverage(const Trajectory& poses, const std::vector<Utime>& breaks, double seconds);

/// Adds coverage, how often and for which share of the time the tracker was lost, and the last reason.
/// `poses`: of the last time the log was played. Needs the report's modes and sequence_s.
void FillTrackedTime(const Trajectory& poses, int loops, report::Report* report);

}  // namespace evit::run
