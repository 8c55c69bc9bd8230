#pragma once

#include <string>

#include "tools/run/latency.h"
#include "tools/run/outages.h"
#include "tools/run/pipeline.h"
#include "tools/run/recorder.h"
#include "tools/run/run.h"
#include "tools/run/run_inputs.h"

namespace evit::run {

/// How a run went, beside what the recorder heard.
struct RunOutcome {
  std::string ended;  // "finished" or "interrupted"
  double wall_s = 0;
  const LatencyProbe* latency = nullptr;  // real time only
  std::chrono::steady_clock::time_point begin, end;
  const Outages* outages = nullptr;
};

/// Writes trajectory.tum, smoothed.tum, covariance.csv, report.json, trajectory.png and, with truth,
/// consistency.png into job.out and says in a few lines how the run went. Returns Run()'s exit code.
int WriteResults(const RunJob& job, const RunInputs& inputs, const Recorder& recorder,
                 const Pipeline& pipeline, const RunOutcome& outcome);

}  // namespace evit::run
