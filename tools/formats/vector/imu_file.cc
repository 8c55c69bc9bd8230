#include "tools/formats/vector/imu_file.h"

#include <stdexcept>

#include "tools/formats/import/imu_columns.h"

namespace evit::formats {

std::vector<ImuSample> ReadImuFile(const std::string& path, DropCounts* dropped) {
  std::vector<ImuSample> samples =
      ReadImuRows(path, "timestamp gx gy gz ax ay az", ImuOrder::kGyroFirst, dropped);
  if (samples.size() < 2) throw std::runtime_error(path + ": contains no IMU samples");
  return samples;
}

}  // namespace evit::formats
