#pragma once

#include <string>

#include "tools/simulation/simulation_settings.h"

namespace evit::simulation {

/// Sets of errors that belong together (docs/reference/simulator.md says where the figures come from).
enum class Profile {
  kIdeal,      // a plain sensor, and a map as a depth camera makes it
  kCameraMap,  // the map of an image-based mapper
  kSensor,  // latency by light, threshold drift, leaks, bursts, bandwidth, lens blur, vibration, saturation
  kReal     // both
};

/// "ideal", "camera-map", "sensor", "real"; false where the name is unknown.
bool ProfileFromName(const std::string& name, Profile* profile);

/// Changes what the profile sets, and nothing else.
void ApplyProfile(Profile profile, SimulationSettings* settings);

}  // namespace evit::simulation
