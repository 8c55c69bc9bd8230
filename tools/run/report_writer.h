#pragma once

#include <string>

#include "common/evaluation/consistency.h"
#include "tools/run/recorder.h"
#include "tools/run/report.pb.h"

namespace evit::run {

/// Adds what the recorder heard: keyframes, modes (their seconds since `log_begin`, us), services' counters
/// and stages.
void FillFromRecorder(const Recorder& recorder, Utime log_begin, report::Report* report);

/// Adds ATE in the three alignments and the milestones.
void FillErrors(const Trajectory& truth, const Trajectory& estimate, report::Report* report);

/// Adds how well the covariances fit the errors.
void FillConsistency(const Consistency& consistency, report::Report* report);

/// Writes the report as JSON, atomically. Throws std::runtime_error naming the file.
void WriteReport(const std::string& path, const report::Report& report);

}  // namespace evit::run
