#include "common/mapping/edge_detector.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "common/mapping/edge_lines.h"

namespace evit {
namespace {

constexpr double kSensorBlur = 0.6;  // pixels: of a sharp step as lens and pixels deliver it
constexpr int kBorder = 4;           // pixels: gradient and brightness need so much around

// Between pixels; requires one pixel around.
float At(const cv::Mat& image, float x, float y) {
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const float a = x - static_cast<float>(column), b = y - static_cast<float>(row);
  const float* upper = image.ptr<float>(row) + column;
  const float* lower = image.ptr<float>(row + 1) + column;
  return (1 - b) * ((1 - a) * upper[0] + a * upper[1]) + b * ((1 - a) * lower[0] + a * lower[1]);
}

class Detector {
 public:
  Detector(const cv::Mat& grey, const cv::Mat& valid, const EdgeDetectorOptions& options)
      : options_(options) {
    const double sigma = options.blur_sigma_px;
    grey.convertTo(light_, CV_32F, 1, options.dark_level);
    cv::GaussianBlur(light_, light_, {}, sigma, sigma, cv::BORDER_REPLICATE);
    cv::Mat kernel = (cv::Mat_<float>(1, 3) << -0.5F, 0, 0.5F);
    cv::filter2D(light_, dx_, CV_32F, kernel);
    cv::filter2D(light_, dy_, CV_32F, kernel.t());
    cv::magnitude(dx_, dy_, size_);
    // A step of contrast c, blurred to s pixels, has the peak gradient c / (s sqrt(2 pi)).
    width_ = static_cast<float>(std::sqrt(2 * M_PI) * std::hypot(sigma, kSensorBlur));
    if (!valid.empty())
      cv::erode(valid, valid_, cv::Mat(), {-1, -1}, kBorder, cv::BORDER_CONSTANT, cv::Scalar(255));
  }

  std::vector<EdgePixel> Run() {
    cv::Mat index(size_.size(), CV_32S, cv::Scalar(-1));
    const auto low = static_cast<float>(options_.min_contrast) / width_;  // of the gradient of the logarithm
    for (int row = kBorder; row < size_.rows - kBorder; ++row) {
      for (int column = kBorder; column < size_.cols - kBorder; ++column) {
        if (size_.at<float>(row, column) < low * light_.at<float>(row, column)) continue;
        if (!valid_.empty() && valid_.at<std::uint8_t>(row, column) == 0) continue;
        if (Peak(column, row)) index.at<int>(row, column) = static_cast<int>(found_.size()) - 1;
      }
    }
    FitNormals(index, &found_);
    std::vector<char> sure;
    sure.reserve(found_.size());
    for (const EdgePixel& e : found_) sure.push_back(e.contrast >= options_.sure_contrast ? 1 : 0);
    return KeepLines(index, found_, sure, options_.min_length);
  }

 private:
  // Adds an edge where the gradient is largest along its direction.
  bool Peak(int column, int row) {
    const float size = size_.at<float>(row, column);
    const Eigen::Vector2f n(dx_.at<float>(row, column) / size, dy_.at<float>(row, column) / size);
    const auto x = static_cast<float>(column), y = static_cast<float>(row);
    const float before = At(size_, x - n.x(), y - n.y()), behind = At(size_, x + n.x(), y + n.y());
    if (size <= before || size < behind) return false;
    const float bend = before - 2 * size + behind;
    const float off = bend < 0 ? std::clamp(0.5F * (before - behind) / bend, -0.7F, 0.7F) : 0.0F;
    EdgePixel e;
    e.pixel = Eigen::Vector2f(x, y) + off * n;
    e.normal = n;
    const auto side = static_cast<float>(options_.side_px);
    e.dark = std::log(At(light_, e.pixel.x() - side * n.x(), e.pixel.y() - side * n.y()));
    e.bright = std::log(At(light_, e.pixel.x() + side * n.x(), e.pixel.y() + side * n.y()));
    e.contrast = size * width_ / light_.at<float>(row, column);
    found_.push_back(e);
    return true;
  }

  EdgeDetectorOptions options_;
  float width_;
  cv::Mat light_, dx_, dy_, size_, valid_;
  std::vector<EdgePixel> found_;
};

}  // namespace

std::vector<EdgePixel> DetectEdges(const cv::Mat& grey, const cv::Mat& valid,
                                   const EdgeDetectorOptions& options) {
  CV_Assert(grey.type() == CV_8UC1 && (valid.empty() || valid.size() == grey.size()));
  return Detector(grey, valid, options).Run();
}

}  // namespace evit
