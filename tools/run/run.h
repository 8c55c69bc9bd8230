#pragma once

#include "tools/run/run_job.h"

namespace evit::run {

/// Starts the services, waits for the end and writes trajectory.tum, smoothed.tum, covariance.csv,
/// report.json, trajectory.png and, with truth, consistency.png into `out`. Returns 0 where it tracked to the
/// end, 2 where it was LOST or never tracked. Throws std::runtime_error where it could not run: a file cannot
/// be used, a service died.
int Run(const RunJob& job);

}  // namespace evit::run
