#pragma once

#include <string>
#include <vector>

#include "common/files/table_reader.h"
#include "common/files/table_sample.h"
#include "common/imu/imu_sample.h"
#include "tools/formats/import/drop_counts.h"

namespace evit::formats {

/// Which column of a text file of IMU samples is which, and in which units.
struct ImuColumns {
  /// Time (or its whole seconds), its nanoseconds in a column of their own, gyro x y z, accelerometer x y z,
  /// or nothing of these.
  enum Field { kTime, kNanoseconds, kGyro, kAccel = kGyro + 3, kIgnored = kAccel + 3 };
  std::vector<int> field;
  TimeUnit unit = TimeUnit::kSeconds;
  double gyro_unit = 1, accel_unit = 1;  // in rad/s and m/s^2
};

/// How a table without names has its columns; kByGravity: the accelerations are those that gravity can be in.
enum class ImuOrder { kGyroFirst, kAccelFirst, kByGravity };

/// By the names of the columns ("w_x", "gyro_y [deg/s]", "ax", "field.linear_acceleration.z") where all of
/// time, gyro and accelerometer are there; others are passed over. Else a time (or seconds and nanoseconds)
/// and six numbers in `usual` order. Throws std::runtime_error naming the file where gravity does not tell.
ImuColumns FindImuColumns(const TableSample& sample, const std::string& path, ImuOrder usual);

/// All samples of a table; rows that are not finite are counted. `layout`: for messages. Throws
/// std::runtime_error naming file, line and field.
std::vector<ImuSample> ReadImuRows(const std::string& path, const std::string& layout, ImuOrder usual,
                                   DropCounts* dropped);

}  // namespace evit::formats
