#include "tools/formats/vector/imu_file.h"

#include <stdexcept>

#include "common/files/table_reader.h"

namespace evit::formats {

std::vector<ImuSample> ReadImuFile(const std::string& path) {
  TableReader rows(path, "timestamp gx gy gz ax ay az");
  std::vector<ImuSample> samples;
  while (rows.Next()) {
    ImuSample s;
    if (!rows.Time(&s.t)) rows.Fail("the time is not finite");
    for (Eigen::Vector3d* v : {&s.gyro, &s.accel}) {
      for (int k = 0; k < 3; ++k) (*v)[k] = rows.Finite();
    }
    if (!samples.empty() && s.t <= samples.back().t) rows.Fail("the time does not increase");
    samples.push_back(s);
  }
  if (samples.size() < 2) throw std::runtime_error(path + ": contains no IMU samples");
  return samples;
}

}  // namespace evit::formats
