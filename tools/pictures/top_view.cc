#include "tools/pictures/top_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "tools/pictures/write_picture.h"

namespace evit::pictures {
namespace {

constexpr int kSide = 1000;         // pixels of the longer side of a plan that is written
constexpr int kLeast = 400;         // pixels of its width, for the legend
constexpr int kBorder = 30;         // pixels around
constexpr int kFooter = 50;         // pixels below, for scale and heights
constexpr double kStrays = 0.005;   // share of the points that may lie outside, at each end
const cv::Scalar kInk(60, 60, 60);  // BGR
const cv::Vec3b kPaper(255, 255, 255);

// Bounds of one coordinate without strays.
std::pair<float, float> Extent(const PointMap& map, int axis) {
  std::vector<float> values;
  values.reserve(map.points.size());
  for (const auto& p : map.points) values.push_back(p[axis]);
  const auto at = [&](double share) {
    const auto k =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), k, values.end());
    return *k;
  };
  const float low = at(kStrays), high = at(1 - kStrays);
  const float slack = std::max(1e-3F, 0.02F * (high - low));
  return {low - slack, high + slack};
}

// A round length of a fifth of the width or less: 1, 2 or 5 times a power of ten.
double ScaleLength(double width) {
  const double limit = width / 5, ten = std::pow(10.0, std::floor(std::log10(limit)));
  return limit >= 5 * ten ? 5 * ten : (limit >= 2 * ten ? 2 * ten : ten);
}

std::string Format(const char* format, double a, double b = 0) {
  char text[100];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

void Write(cv::Mat* picture, const std::string& text, cv::Point at) {
  cv::putText(*picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.5, kInk, 1, cv::LINE_AA);
}

}  // namespace

TopView DrawTopView(const PointMap& map, int side, const std::vector<Eigen::Vector2d>& also,
                    const std::string& height_name) {
  auto x = Extent(map, 0), y = Extent(map, 1);
  const auto z = Extent(map, 2);
  for (const Eigen::Vector2d& p : also) {
    x = {std::min(x.first, static_cast<float>(p.x())), std::max(x.second, static_cast<float>(p.x()))};
    y = {std::min(y.first, static_cast<float>(p.y())), std::max(y.second, static_cast<float>(p.y()))};
  }
  const double width = x.second - x.first, height = y.second - y.first;
  const double scale = side / std::max(width, height);  // pixels per metre
  const cv::Size plan(std::max(kLeast, static_cast<int>(width * scale)),
                      static_cast<int>(height * scale) + 1);
  cv::Mat picture(plan.height + 2 * kBorder + kFooter, plan.width + 2 * kBorder, CV_8UC3, kPaper);
  const auto pixel = [&](double px, double py) {
    return cv::Point(kBorder + static_cast<int>((px - x.first) * scale),
                     kBorder + static_cast<int>((y.second - py) * scale));
  };

  cv::Mat ramp(1, 256, CV_8U), colours;
  for (int k = 0; k < 256; ++k) ramp.at<std::uint8_t>(0, k) = static_cast<std::uint8_t>(k);
  cv::applyColorMap(ramp, colours, cv::COLORMAP_TURBO);
  // The highest point of each pixel is what one sees from above.
  cv::Mat top(picture.size(), CV_32F, -std::numeric_limits<float>::infinity());
  for (const auto& p : map.points) {
    if (p.x() < x.first || p.x() > x.second || p.y() < y.first || p.y() > y.second) continue;
    const cv::Point at = pixel(p.x(), p.y());
    if (p.z() <= top.at<float>(at)) continue;
    top.at<float>(at) = p.z();
    const float level = std::clamp((p.z() - z.first) / (z.second - z.first), 0.0F, 1.0F);
    picture.at<cv::Vec3b>(at) = colours.at<cv::Vec3b>(0, static_cast<int>(255 * level));
  }

  if (x.first < 0 && x.second > 0 && y.first < 0 && y.second > 0) {
    const cv::Point origin = pixel(0, 0);
    cv::arrowedLine(picture, origin, origin + cv::Point(40, 0), {0, 0, 220}, 2, cv::LINE_AA);
    cv::arrowedLine(picture, origin, origin - cv::Point(0, 40), {0, 160, 0}, 2, cv::LINE_AA);
  }
  const double length = ScaleLength(plan.width / scale);
  const int base = picture.rows - 20, bar = static_cast<int>(length * scale);
  cv::line(picture, {kBorder, base}, {kBorder + bar, base}, kInk, 3);
  Write(&picture, Format("%g m", length), {kBorder, base - 8});
  constexpr int kLegend = 180;  // pixels
  const int right = picture.cols - kBorder - kLegend;
  cv::Mat legend = picture(cv::Rect(right, base - 6, kLegend, 8));
  cv::resize(colours, legend, legend.size(), 0, 0, cv::INTER_AREA);
  Write(&picture, height_name + Format(" %.2f .. %.2f m", z.first, z.second), {right, base - 12});
  return {picture, scale, {kBorder - x.first * scale, kBorder + y.second * scale}};
}

void WriteTopView(const std::string& path, const PointMap& map, const std::string& height) {
  WritePicture(path, DrawTopView(map, kSide, {}, height).picture);
}

}  // namespace evit::pictures
