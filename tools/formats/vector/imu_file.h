#pragma once

#include <string>
#include <vector>

#include "common/imu/imu_sample.h"
#include "tools/formats/import/drop_counts.h"

namespace evit::formats {

/// VECtor's `*.synced.imu.txt`: '#' lines, then `timestamp gx gy gz ax ay az [qx qy qz qw]` (s, rad/s,
/// m/s^2), in the file's order. The orientation is left unread; names in the head may give another order.
/// Rows that are not finite are counted and left out. Throws std::runtime_error naming file, line and what is
/// wrong (numbers, too few).
std::vector<ImuSample> ReadImuFile(const std::string& path, DropCounts* dropped);

}  // namespace evit::formats
