#pragma once

#include <vector>

#include "common/diagnosis/finding.h"
#include "common/geometry/rig.h"
#include "common/imu/imu_sample.h"

namespace evit::diagnosis {

/// Rate, gaps, order, units, gravity, saturation and noise of an IMU, against what the rig file says of it.
/// `samples`: in the order of the recording.
Findings CheckImu(const std::vector<ImuSample>& samples, const Rig& rig);

}  // namespace evit::diagnosis
