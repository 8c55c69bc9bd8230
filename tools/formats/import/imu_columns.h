#pragma once

#include <string>
#include <vector>

#include "common/files/table_reader.h"
#include "common/files/table_sample.h"
#include "common/imu/imu_sample.h"

namespace evit::formats {

/// Which column of a text file of IMU samples is which, and in which unit the stamps are.
struct ImuColumns {
  /// Time, gyro x y z, accelerometer x y z, or nothing of these.
  enum Field { kTime, kGyro, kAccel = kGyro + 3, kIgnored = kAccel + 3 };
  std::vector<int> field;
  TimeUnit unit = TimeUnit::kSeconds;
};

/// Told from the names of the columns ("w_x", "gyro_y", "ax", "acc.z", "angular_velocity_x"), where all seven
/// are there, else `usual`: the field of each column.
ImuColumns FindImuColumns(const std::string& path, const std::string& layout, const std::vector<int>& usual);

/// The next row; false where it is not finite. Throws as TableReader does.
bool ReadImuRow(const ImuColumns& columns, TableReader* rows, ImuSample* sample);

}  // namespace evit::formats
