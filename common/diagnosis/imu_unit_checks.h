#pragma once

#include <vector>

#include "common/diagnosis/finding.h"
#include "common/imu/imu_sample.h"

namespace evit::diagnosis {

/// Whether the accelerometer reads m/s^2, gravity included. `gravity`: m/s^2. At least one sample.
Finding CheckAccelUnit(const std::vector<ImuSample>& samples, double gravity);

/// Whether the gyro reads rad/s, in the axes of the accelerometer. At least one sample.
Finding CheckGyroUnit(const std::vector<ImuSample>& samples);

}  // namespace evit::diagnosis
