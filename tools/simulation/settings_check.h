#pragma once

#include "common/geometry/rig.h"
#include "tools/simulation/simulation_settings.h"

namespace evit::simulation {

/// Throws std::runtime_error naming the first setting that is out of range, or what the rig lacks.
void CheckSettings(const SimulationSettings& settings, const Rig& rig);

}  // namespace evit::simulation
