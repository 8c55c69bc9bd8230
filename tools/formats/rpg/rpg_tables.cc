#include "tools/formats/rpg/rpg_tables.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/files/table_reader.h"
#include "tools/formats/import/imu_columns.h"

namespace evit::formats {

std::vector<ImuSample> ReadRpgImu(const std::string& path, DropCounts* dropped) {
  return ReadImuRows(path, "t ax ay az gx gy gz", ImuOrder::kAccelFirst, dropped);
}

Camera ReadRpgCamera(const std::string& path, int width, int height) {
  TableReader lines(path, "fx fy cx cy k1 k2 p1 p2 k3");
  if (!lines.Next()) throw std::runtime_error(path + ": is empty; expected fx fy cx cy k1 k2 p1 p2 k3");
  Camera camera;
  camera.width = width;
  camera.height = height;
  for (double* x : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) *x = lines.Number();
  for (double& x : camera.distortion) {
    x = lines.Number();
    if (!std::isfinite(x)) lines.Fail("k1 k2 p1 p2 k3: expected finite numbers");
  }
  lines.End();
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (!positive(camera.fx) || !positive(camera.fy)) lines.Fail("fx fy: expected positive numbers");
  if (!(camera.cx >= 0 && camera.cx <= width && camera.cy >= 0 && camera.cy <= height)) {
    lines.Fail("cx cy: the principal point is not in an image of " + std::to_string(width) + "x" +
               std::to_string(height) + "; give the image's size as --size WxH");
  }
  return camera;
}

double ImuRate(const std::vector<ImuSample>& samples) {
  std::vector<Utime> gaps;
  for (std::size_t k = 1; k < samples.size(); ++k) gaps.push_back(samples[k].t - samples[k - 1].t);
  if (gaps.empty()) return 0;
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  return std::round(1e6 / static_cast<double>(*middle));
}

}  // namespace evit::formats
