#include "tools/simulation/edge_pixels.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/simulation/event_sensor.h"

namespace evit::simulation {
namespace {

float Bilinear(const cv::Mat& image, double x, double y) {
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const float *a = image.ptr<float>(y0) + x0, *b = image.ptr<float>(y0 + 1) + x0;
  return (1 - fy) * ((1 - fx) * a[0] + fx * a[1]) + fy * ((1 - fx) * b[0] + fx * b[1]);
}

// At a depth edge the border belongs to the nearer surface, though the pixel's centre may see the farther.
double NearestInverseDepth(const View& view, int width, int x, int y) {
  const std::size_t i = static_cast<std::size_t>(y) * width + x;
  const float centre = view.inverse_depth[i];
  float nearest = centre;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      nearest = std::max(nearest, view.inverse_depth[i + static_cast<std::ptrdiff_t>(dy) * width + dx]);
    }
  }
  return nearest > 1.03F * centre ? nearest : centre;
}

}  // namespace

std::vector<EdgePixel> FindEdges(const View& view, int width, int height, double threshold) {
  cv::Mat log_image(height, width, CV_32F);
  for (std::size_t i = 0; i < view.image.size(); ++i) {
    log_image.ptr<float>()[i] = FastLog(view.image[i] + 3.0F);
  }
  return FindEdgesIn(log_image, view, threshold);
}

std::vector<EdgePixel> FindEdgesIn(cv::Mat image, const View& view, double threshold) {
  const int width = image.cols, height = image.rows;
  cv::GaussianBlur(image, image, {5, 5}, 0.8);
  cv::Mat gx, gy, magnitude;
  cv::Sobel(image, gx, CV_32F, 1, 0, 3, 0.125);
  cv::Sobel(image, gy, CV_32F, 0, 1, 3, 0.125);
  cv::magnitude(gx, gy, magnitude);
  std::vector<EdgePixel> edges;
  constexpr int kBorder = 4;
  for (int y = kBorder; y < height - kBorder; ++y) {
    for (int x = kBorder; x < width - kBorder; ++x) {
      const double m = magnitude.at<float>(y, x);
      if (m < threshold) continue;
      const Eigen::Vector2d normal = Eigen::Vector2d(gx.at<float>(y, x), gy.at<float>(y, x)) / m;
      const double before = Bilinear(magnitude, x - normal.x(), y - normal.y());
      const double after = Bilinear(magnitude, x + normal.x(), y + normal.y());
      if (m < before || m <= after) continue;
      const double bend = before - 2 * m + after;  // of the parabola through the three: negative here
      const double offset = bend < -1e-9 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
      const double inverse_depth = NearestInverseDepth(view, width, x, y);
      if (inverse_depth > 0)
        edges.push_back({Eigen::Vector2d(x, y) + offset * normal, normal, inverse_depth});
    }
  }
  return edges;
}

}  // namespace evit::simulation
