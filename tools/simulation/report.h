#pragma once

#include <string>

#include "tools/simulation/simulation_settings.h"
#include "tools/simulation/simulation_summary.h"

namespace evit::simulation {

/// Writes simulation.json: what was asked for and what came of it. Throws std::runtime_error naming the file.
void WriteReport(const std::string& path, const SimulationSettings& settings,
                 const SimulationSummary& summary);

}  // namespace evit::simulation
