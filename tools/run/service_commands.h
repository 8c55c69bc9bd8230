#pragma once

#include <optional>
#include <string>
#include <vector>

#include "procman/procman_command.h"
#include "tools/run/run_inputs.h"
#include "tools/run/run_job.h"

namespace evit::run {

/// The command lines of the four services for a run, in the order they are started: each before those that
/// send to it. `url`: of the bus. `inputs`: where to start, which channels of the log to play. Removes what
/// an earlier run left for restarts.
std::vector<procman::ProcmanCommand> ServiceCommands(const RunJob& job, const std::string& url,
                                                     const RunInputs& inputs);

/// Removes the files that services keep for restarts within a run.
void RemoveRestartFiles(const RunJob& job);

}  // namespace evit::run
