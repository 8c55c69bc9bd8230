#pragma once

#include <CLI/CLI.hpp>

#include "tools/run/run_job.h"

namespace evit::commands {

/// --near, --height, --yaw: what is known of the place that is looked for (ParsePlacePrior).
void AddPlaceOptions(CLI::App* command, run::PlaceTexts* place);

}  // namespace evit::commands
