#include "tools/formats/vector/imu_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "common/evaluation/decimal_time.h"

namespace evit::formats {

std::vector<ImuSample> ReadImuFile(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  std::vector<ImuSample> samples;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const auto fail = [&](const std::string& what) {
      throw std::runtime_error(
          std::string(path).append(":").append(std::to_string(number)).append(": ").append(what));
    };
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::string stamp;
    if (!(words >> stamp) || stamp[0] == '#') continue;
    ImuSample s;
    if (!ParseDecimalSeconds(stamp, &s.t)) fail("\"" + stamp + "\" is not a time in decimal seconds");
    for (Eigen::Vector3d* v : {&s.gyro, &s.accel}) {
      for (int k = 0; k < 3; ++k) {
        if (!(words >> (*v)[k]) || !std::isfinite((*v)[k])) {
          fail("expected seven finite numbers: timestamp gx gy gz ax ay az");
        }
      }
    }
    if (!samples.empty() && s.t <= samples.back().t) fail("the time does not increase");
    samples.push_back(s);
  }
  if (samples.size() < 2) throw std::runtime_error(path + ": holds no IMU samples");
  return samples;
}

}  // namespace evit::formats
