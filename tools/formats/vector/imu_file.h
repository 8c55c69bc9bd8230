#pragma once

#include <string>
#include <vector>

#include "common/imu/imu_sample.h"

namespace evit::formats {

/// VECtor's `*.synced.imu.txt`: '#' lines, then `timestamp gx gy gz ax ay az [qx qy qz qw]` (s, rad/s,
/// m/s^2). The orientation is left unread. Throws std::runtime_error naming file, line and what is wrong
/// (numbers, order, too few).
std::vector<ImuSample> ReadImuFile(const std::string& path);

}  // namespace evit::formats
