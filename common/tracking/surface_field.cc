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
  float row[3], row_d[3];
  const std::size_t step = image.step;
  const std::uint8_t* data = image.data + (j - 1) * step + (i - 1);
  for (int k = 0; k < 3; ++k, data += step) {
    const float p0 = data[0], p1 = data[1], p2 = data[2];
    row[k] = wx[0] * p0 + wx[1] * p1 + wx[2] * p2;
    row_d[k] = dx[0] * p0 + dx[1] * p1 + dx[2] * p2;
  }
  Sample s;
  s.value = wy[0] * row[0] + wy[1] * row[1] + wy[2] * row[2];
  s.gx = (wy[0] * row_d[0] + wy[1] * row_d[1] + wy[2] * row_d[2]) * static_cast<float>(scale);
  s.gy = ((b - 0.5f) * row[0] - 2.0f * b * row[1] + (b + 0.5f) * row[2]) * static_cast<float>(scale);
  if (cu != u) s.gx = 0;
  if (cv != v) s.gy = 0;
  return s;
}

}  // namespace evit
