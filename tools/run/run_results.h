#pragma once

#include <string>

#include "tools/run/pipeline.h"
#include "tools/run/recorder.h"
#include "tools/run/run_inputs.h"
#include "tools/run/run_job.h"
#include "tools/run/run_outcome.h"

namespace evit::run {

/// Writes trajectory.tum, smoothed.tum, covariance.csv, report.json, trajectory.png and, with truth,
/// consistency.png into job.out and says in a few lines how the run went. Returns Run()'s exit code.
int WriteResults(const RunJob& job, const RunInputs& inputs, const Recorder& recorder,
                 const Pipeline& pipeline, const RunOutcome& outcome);

}  // namespace evit::run
