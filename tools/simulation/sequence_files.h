#pragma once

#include <string>

#include "common/geometry/rig.h"
#include "tools/simulation/motion.h"
#include "tools/simulation/simulated_imu.h"

namespace evit::simulation {

/// All throw std::runtime_error naming the file.
void WriteImuFile(const std::string& path, const SimulatedImu& imu);
/// Marker poses at 120 Hz, as the motion capture gives them.
void WriteGroundTruthFile(const std::string& path, const std::string& name, const Motion& motion,
                          const Rig& rig);
void WriteTruth(const std::string& path, const Motion& motion, const SimulatedImu& imu);

}  // namespace evit::simulation
