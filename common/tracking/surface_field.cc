#include "common/tracking/surface_field.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace evit {

SurfaceField::SurfaceField(const cv::Mat& surface, int levels) {
  pyramid_.reserve(levels);
  pyramid_.push_back(surface.clone());
  for (int l = 1; l < levels; ++l) {
    cv::Mat half;
    cv::pyrDown(pyramid_.back(), half);  // its pixel (i, j) lies on (2i, 2j)
    pyramid_.push_back(half);
  }
  mean_ = cv::mean(surface)[0];
}

SurfaceField::Sample SurfaceField::At(int level, double x, double y) const {
  const cv::Mat& image = pyramid_[level];
  const double scale = 1.0 / (1 << level);
  // Nearest pixel (i, j) with one neighbour on each side; a and b are -0.5 .. 0.5 from it.
  const double u = x * scale, v = y * scale;
  const double cu = std::clamp(u, 1.0, image.cols - 2.0), cv = std::clamp(v, 1.0, image.rows - 2.0);
  const int i = static_cast<int>(cu + 0.5), j = static_cast<int>(cv + 0.5);
  const auto a = static_cast<float>(cu - i), b = static_cast<float>(cv - j);
  const float wx[3] = {0.5f * (0.5f - a) * (0.5f - a), 0.75f - a * a, 0.5f * (0.5f + a) * (0.5f + a)};
  const float wy[3] = {0.5f * (0.5f - b) * (0.5f - b), 0.75f - b * b, 0.5f * (0.5f + b) * (0.5f + b)};
  const float dx[3] = {a - 0.5f, -2.0f * a, a + 0.5f};
  float row[3], row_d[3], row_dd[3];
  const std::size_t step = image.step;
  const std::uint8_t* data = image.data + (j - 1) * step + (i - 1);
  for (int k = 0; k < 3; ++k, data += step) {
    const float p0 = data[0], p1 = data[1], p2 = data[2];
    row[k] = wx[0] * p0 + wx[1] * p1 + wx[2] * p2;
    row_d[k] = dx[0] * p0 + dx[1] * p1 + dx[2] * p2;
    row_dd[k] = p0 - 2.0f * p1 + p2;
  }
  Sample s;
  s.value = wy[0] * row[0] + wy[1] * row[1] + wy[2] * row[2];
  const float dy[3] = {b - 0.5f, -2.0f * b, b + 0.5f};
  const auto k1 = static_cast<float>(scale), k2 = k1 * k1;
  s.gx = k1 * (wy[0] * row_d[0] + wy[1] * row_d[1] + wy[2] * row_d[2]);
  s.gy = k1 * (dy[0] * row[0] + dy[1] * row[1] + dy[2] * row[2]);
  s.hxx = k2 * (wy[0] * row_dd[0] + wy[1] * row_dd[1] + wy[2] * row_dd[2]);
  s.hxy = k2 * (dy[0] * row_d[0] + dy[1] * row_d[1] + dy[2] * row_d[2]);
  s.hyy = k2 * (row[0] - 2.0f * row[1] + row[2]);
  if (cu != u) s.gx = s.hxx = s.hxy = 0;
  if (cv != v) s.gy = s.hyy = s.hxy = 0;
  return s;
}

}  // namespace evit
