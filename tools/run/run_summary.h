#pragma once

#include <string>

#include "common/evaluation/consistency.h"
#include "common/evaluation/trajectory.h"
#include "tools/run/report.pb.h"
#include "tools/run/run_inputs.h"
#include "tools/run/run_job.h"
#include "tools/run/run_verdict.h"

namespace evit::run {

/// One line that says how the run went, also over its picture: name of the log, ATE (cm, deg), coverage,
/// how often it was lost. `poses`: those that were scored.
std::string RunTitle(const RunJob& job, const report::Report& report, const Trajectory& poses);

/// How often and for which share of the time the tracker was lost, why at last, and what to ask; empty:
/// never.
std::string LossesText(const RunJob& job, const report::Report& report);

/// Says on stdout in a few lines how the run went, what got lost and where the results are. `consistency` is
/// empty without truth; `latency`: whether it was measured.
void PrintSummary(const RunJob& job, const RunInputs& inputs, const report::Report& report,
                  const std::string& title, const Consistency& consistency, bool latency);

}  // namespace evit::run
