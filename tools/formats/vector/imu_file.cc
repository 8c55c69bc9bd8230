#include "tools/formats/vector/imu_file.h"

#include <stdexcept>

#include "common/evaluation/decimal_time.h"
#include "common/files/number_rows.h"

namespace evit::formats {

std::vector<ImuSample> ReadImuFile(const std::string& path) {
  NumberRows rows(path, "timestamp gx gy gz ax ay az", "VECtor's IMU file");
  std::vector<ImuSample> samples;
  while (rows.Next()) {
    ImuSample s;
    if (!ParseDecimalSeconds(rows.first(), &s.t))
      rows.Fail("\"" + rows.first() + "\" is not a time in decimal seconds");
    for (Eigen::Vector3d* v : {&s.gyro, &s.accel}) {
      for (int k = 0; k < 3; ++k) (*v)[k] = rows.Number();
    }
    if (!samples.empty() && s.t <= samples.back().t) rows.Fail("the time does not increase");
    samples.push_back(s);
  }
  if (samples.size() < 2) throw std::runtime_error(path + ": contains no IMU samples");
  return samples;
}

}  // namespace evit::formats
