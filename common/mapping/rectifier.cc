#include "common/mapping/rectifier.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace evit {
namespace {

constexpr double kMaxSlope = 2;  // tangent of the largest angle off the axis, in x and in y

}  // namespace

Rectifier::Rectifier(const Camera& camera) : pinhole_(camera) {
  // What lies on the image's border, in slopes.
  Eigen::Vector2d low(0, 0), high(0, 0);
  const auto look = [&](double column, double row) {
    Eigen::Vector3d ray;
    if (!camera.Unproject({column, row}, &ray)) return;
    low = low.cwiseMin(ray.head<2>());
    high = high.cwiseMax(ray.head<2>());
  };
  for (int column = 0; column < camera.width; ++column) look(column, 0), look(column, camera.height - 1);
  for (int row = 0; row < camera.height; ++row) look(0, row), look(camera.width - 1, row);
  low = low.cwiseMax(-kMaxSlope);
  high = high.cwiseMin(kMaxSlope);

  pinhole_.model = Camera::Model::kPlumbBob;
  pinhole_.distortion = {};
  // Whole pixels beside the original: an image without distortion stays as it is, bit by bit.
  pinhole_.cx += std::ceil(-low.x() * camera.fx - camera.cx - 1e-6);
  pinhole_.cy += std::ceil(-low.y() * camera.fy - camera.cy - 1e-6);
  pinhole_.width = static_cast<int>(std::ceil(pinhole_.cx + high.x() * camera.fx - 1e-6)) + 1;
  pinhole_.height = static_cast<int>(std::ceil(pinhole_.cy + high.y() * camera.fy - 1e-6)) + 1;

  columns_.create(pinhole_.height, pinhole_.width, CV_32F);
  rows_.create(columns_.size(), CV_32F);
  valid_.create(columns_.size(), CV_8U);
  for (int row = 0; row < pinhole_.height; ++row) {
    for (int column = 0; column < pinhole_.width; ++column) {
      const Eigen::Vector3d ray((column - pinhole_.cx) / camera.fx, (row - pinhole_.cy) / camera.fy, 1);
      Eigen::Vector2d pixel;
      const bool seen = camera.Project(ray, &pixel) && camera.Contains(pixel);
      columns_.at<float>(row, column) = seen ? static_cast<float>(pixel.x()) : -10.0F;
      rows_.at<float>(row, column) = seen ? static_cast<float>(pixel.y()) : -10.0F;
      valid_.at<std::uint8_t>(row, column) = seen ? 255 : 0;
    }
  }
}

cv::Mat Rectifier::Rectify(const cv::Mat& image) const {
  cv::Mat rectified;
  cv::remap(image, rectified, columns_, rows_, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return rectified;
}

}  // namespace evit
