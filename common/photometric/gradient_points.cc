#include "common/photometric/gradient_points.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace evit {
namespace {

// Halves both images; a pixel whose four parts do not all see something sees nothing.
void Halve(cv::Mat* log_intensity, cv::Mat* inverse_depth) {
  const int rows = log_intensity->rows / 2, columns = log_intensity->cols / 2;
  cv::Mat l(rows, columns, CV_32F), d(rows, columns, CV_32F);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      float sum = 0, nearest = 0, farthest = 1e9F;
      for (int k = 0; k < 4; ++k) {
        const int v = 2 * y + k / 2, u = 2 * x + k % 2;
        sum += log_intensity->at<float>(v, u);
        nearest = std::max(nearest, inverse_depth->at<float>(v, u));
        farthest = std::min(farthest, inverse_depth->at<float>(v, u));
      }
      l.at<float>(y, x) = 0.25F * sum;
      d.at<float>(y, x) = farthest > 0 ? nearest : 0;
    }
  }
  *log_intensity = l;
  *inverse_depth = d;
}

// What lies in view but is not seen must not look like an edge: it gets the blurred brightness around it.
cv::Mat BlurSeen(const cv::Mat& log_intensity, const cv::Mat& inverse_depth, double sigma) {
  cv::Mat seen, sum, weight;
  cv::Mat(inverse_depth > 0).convertTo(seen, CV_32F, 1.0 / 255);
  if (sigma <= 0) return log_intensity.clone();
  cv::GaussianBlur(log_intensity.mul(seen), sum, {0, 0}, sigma);
  cv::GaussianBlur(seen, weight, {0, 0}, sigma);
  return sum / cv::max(weight, 1e-6F);
}

}  // namespace

std::vector<GradientPoint> FindGradientPoints(const PhotometricView& view, int level, double blur_sigma,
                                              double min_gradient, int max_points) {
  const Camera& camera = view.query.camera;
  cv::Mat light =
      cv::Mat(camera.height, camera.width, CV_32F, const_cast<float*>(view.log_intensity.data())).clone();
  cv::Mat depth =
      cv::Mat(camera.height, camera.width, CV_32F, const_cast<float*>(view.inverse_depth.data())).clone();
  for (int k = 0; k < level; ++k) Halve(&light, &depth);
  const cv::Mat smooth = BlurSeen(light, depth, blur_sigma);
  const double scale = 1 << level;
  const double fx = camera.fx / scale, fy = camera.fy / scale;
  const double cx = (camera.cx + 0.5) / scale - 0.5, cy = (camera.cy + 0.5) / scale - 0.5;
  struct Found {
    int x, y;
    float gx, gy, inverse;
  };
  std::vector<Found> found;
  const auto limit = static_cast<float>(min_gradient * min_gradient);
  for (int y = 2; y + 2 < smooth.rows; ++y) {
    for (int x = 2; x + 2 < smooth.cols; ++x) {
      const float gx = 0.5F * (smooth.at<float>(y, x + 1) - smooth.at<float>(y, x - 1));
      const float gy = 0.5F * (smooth.at<float>(y + 1, x) - smooth.at<float>(y - 1, x));
      if (!(gx * gx + gy * gy >= limit)) continue;
      float nearest = 0, farthest = 1e9F;
      for (int v = -2; v <= 2; ++v) {
        for (int u = -2; u <= 2; ++u) {
          const float d = depth.at<float>(y + v, x + u);
          if (std::abs(u) < 2 && std::abs(v) < 2) nearest = std::max(nearest, d);
          farthest = std::min(farthest, d);
        }
      }
      if (farthest > 0) found.push_back({x, y, gx, gy, nearest});
    }
  }
  const std::size_t stride = std::max<std::size_t>(
      1, (found.size() + static_cast<std::size_t>(max_points) - 1) / static_cast<std::size_t>(max_points));
  const Eigen::Matrix3d R = view.query.T_map_camera.R();
  std::vector<GradientPoint> points;
  points.reserve(found.size() / stride + 1);
  for (std::size_t k = 0; k < found.size(); k += stride) {
    const Found& f = found[k];
    const double rho = f.inverse, rx = (f.x - cx) / fx, ry = (f.y - cy) / fy;
    const Eigen::Vector3d p(rx / rho, ry / rho, 1 / rho);
    const double a = f.gx * fx, b = f.gy * fy;
    const Eigen::Vector3d gradient = rho * Eigen::Vector3d(a, b, -(a * rx + b * ry));
    points.push_back({R * p + view.query.T_map_camera.p, R * gradient});
  }
  return points;
}

}  // namespace evit
