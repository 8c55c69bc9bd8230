#pragma once

#include <string>

#include "tools/formats/import/import_log.h"

namespace evit::formats {

/// IMU samples of numpy's files, appended: rows of a stamp and six numbers (told apart by gravity) or of
/// named fields, in one array; or arrays for stamp, gyro and accelerometer ("imu_t", "gyro" of N x 3, "accel"
/// of N x 3; "imu/t", ...). What is no IMU is passed over. Throws std::runtime_error naming the file where
/// several arrays may be the IMU's.
void ReadNpyImu(const std::string& path, ImportStreams* streams);

}  // namespace evit::formats
