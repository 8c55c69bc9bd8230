#include "common/photometric/event_image.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace evit {

EventImage::EventImage(const cv::Mat& counts, double contrast_threshold, double blur_sigma, int levels) {
  constexpr double kZero = 128;
  cv::Mat change, level;
  counts.convertTo(change, CV_32F, contrast_threshold, -kZero * contrast_threshold);
  for (int k = 0; k < levels; ++k) {
    cv::resize(change, level, {change.cols / 2, change.rows / 2}, 0, 0, cv::INTER_AREA);
    change = level.clone();
    cv::Mat smooth = level.clone();
    if (blur_sigma > 0) cv::GaussianBlur(level, smooth, {0, 0}, blur_sigma, 0, cv::BORDER_CONSTANT);
    pyramid_.push_back(smooth);
  }
}

EventImage::Sample EventImage::At(int level, double x, double y) const {
  const cv::Mat& image = pyramid_[static_cast<std::size_t>(level)];
  const double scale = 1.0 / (2 << level);  // its pixel 0 is the mean of the first 2^(level+1)
  const double u = (x + 0.5) * scale - 0.5, v = (y + 0.5) * scale - 0.5;
  if (!(u > 1 && v > 1 && u < image.cols - 2 && v < image.rows - 2)) return {0, 0, 0};
  const int cu = static_cast<int>(std::lround(u)), cv = static_cast<int>(std::lround(v));
  const auto a = static_cast<float>(u - cu), b = static_cast<float>(v - cv);  // -0.5 .. 0.5
  const float wx[3] = {0.5F * (0.5F - a) * (0.5F - a), 0.75F - a * a, 0.5F * (0.5F + a) * (0.5F + a)};
  const float wy[3] = {0.5F * (0.5F - b) * (0.5F - b), 0.75F - b * b, 0.5F * (0.5F + b) * (0.5F + b)};
  const float dx[3] = {a - 0.5F, -2 * a, a + 0.5F}, dy[3] = {b - 0.5F, -2 * b, b + 0.5F};
  Sample s{0, 0, 0};
  for (int j = 0; j < 3; ++j) {
    const auto* const row = image.ptr<float>(cv - 1 + j) + cu - 1;
    const float line = wx[0] * row[0] + wx[1] * row[1] + wx[2] * row[2];
    s.value += wy[j] * line;
    s.gx += wy[j] * (dx[0] * row[0] + dx[1] * row[1] + dx[2] * row[2]);
    s.gy += dy[j] * line;
  }
  s.gx *= static_cast<float>(scale);
  s.gy *= static_cast<float>(scale);
  return s;
}

}  // namespace evit
