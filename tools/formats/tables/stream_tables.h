#pragma once

#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/imu/imu_sample.h"
#include "tools/formats/import/drop_counts.h"

namespace evit::formats {

/// IMU samples from any text table of stamp and six numbers (TUM-VIE, EDS, EuRoC, VECtor, RPG, own ones).
/// Which three are angular rates and which accelerations: by the columns' names, else by gravity, which only
/// the accelerations show. The stamps' unit by name or size (UnitOfStamps). Values are taken as rad/s and
/// m/s^2, unless a name says deg/s or g. Throws std::runtime_error naming the file; rows out of order or not
/// finite are counted and left out.
std::vector<ImuSample> ReadImuTable(const std::string& path, DropCounts* dropped);

/// Poses from any text table of stamp, position and quaternion (TUM, TUM-VIE, EDS; EuRoC with w first, by the
/// columns' names).
Trajectory ReadPoseTable(const std::string& path, DropCounts* dropped);

}  // namespace evit::formats
