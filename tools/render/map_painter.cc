#include "tools/render/map_painter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "common/geometry/degrees.h"

namespace evit::render {
namespace {

constexpr double kFieldOfView = 45 / kDegreesPerRadian;  // rad, vertical
constexpr double kTilt = 32 / kDegreesPerRadian;         // rad: looks down by this
constexpr double kNear = 0.05;                           // m
constexpr double kStrays = 0.02;                         // share of points that may lie outside, at each end
constexpr std::size_t kMostPoints = 300'000;

cv::Scalar Rgb(unsigned hex) {
  return {double(hex & 255U), double(hex >> 8 & 255U), double(hex >> 16 & 255U)};
}

float Quantile(std::vector<float>* values, double share) {
  const auto k =
      values->begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values->size() - 1));
  std::nth_element(values->begin(), k, values->end());
  return *k;
}

}  // namespace

Theme LightTheme() {
  return {Rgb(0xffffff), Rgb(0x1c2430), Rgb(0x8a94a3), Rgb(0x0072b2),
          Rgb(0x00224e), Rgb(0x66696f), Rgb(0xb39a2f)};
}

Theme DarkTheme() {
  return {Rgb(0x182029), Rgb(0xe4e9f0), Rgb(0x7d8a9b), Rgb(0x56b4e9),
          Rgb(0x3f5f8f), Rgb(0x9a9a92), Rgb(0xf5df6a)};
}

MapPainter::MapPainter(std::vector<Eigen::Vector3f> points, cv::Size size, double turn, const Theme& theme)
    : points_(std::move(points)), size_(size), theme_(theme), turn_(turn) {
  const std::size_t step = points_.size() / kMostPoints + 1;
  std::size_t n = 0;
  for (std::size_t i = 0; i < points_.size(); i += step) points_[n++] = points_[i];
  points_.resize(n);
  Frame();
  Look(turn);
}

void MapPainter::Frame() {
  Eigen::Vector3d min = Eigen::Vector3d::Zero(), max = Eigen::Vector3d::Ones();
  for (int axis = 0; axis < 3 && !points_.empty(); ++axis) {
    std::vector<float> values;
    values.reserve(points_.size());
    for (const Eigen::Vector3f& p : points_) values.push_back(p[axis]);
    min[axis] = static_cast<double>(Quantile(&values, kStrays));
    max[axis] = static_cast<double>(Quantile(&values, 1 - kStrays));
  }
  center_ = (min + max) / 2;
  radius_ = std::max(0.2, (max - min).norm() / 2);
  low_ = static_cast<float>(min.z());
  high_ = std::max(static_cast<float>(max.z()), low_ + 0.1F);
}

void MapPainter::Look(double turn) {
  turn_ = turn;
  dot_ = std::max(1, size_.height / 400);
  focal_ = 0.5 * size_.height / std::tan(kFieldOfView / 2);
  const double share = std::min(1.0, static_cast<double>(size_.width) / size_.height);
  const double distance = radius_ / std::sin(kFieldOfView / 2) / share * 0.88;
  const Eigen::Vector3d forward(std::cos(kTilt) * std::cos(turn), std::cos(kTilt) * std::sin(turn),
                                -std::sin(kTilt));
  const Eigen::Vector3d right(std::sin(turn), -std::cos(turn), 0);
  Eigen::Matrix3d R_map_view;
  R_map_view << right, forward.cross(right), forward;
  T_view_map_ = SE3(Eigen::Quaterniond(R_map_view), center_ - distance * forward).Inverse();
}

std::optional<Eigen::Vector3d> MapPainter::Project(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d p = T_view_map_ * point;
  if (p.z() < kNear) return std::nullopt;
  return Eigen::Vector3d(size_.width / 2.0 + focal_ * p.x() / p.z(),
                         size_.height / 2.0 + focal_ * p.y() / p.z(), p.z());
}

// Sixteen steps, so that moving pictures pack well.
cv::Vec3b MapPainter::ColorAt(float height) const {
  const double t = std::round(16 * std::clamp<double>((height - low_) / (high_ - low_), 0, 1)) / 16;
  const cv::Scalar color = t < 0.5 ? theme_.low + (theme_.middle - theme_.low) * (2 * t)
                                   : theme_.middle + (theme_.high - theme_.middle) * (2 * t - 1);
  return {cv::saturate_cast<std::uint8_t>(color[0]), cv::saturate_cast<std::uint8_t>(color[1]),
          cv::saturate_cast<std::uint8_t>(color[2])};
}

const cv::Mat& MapPainter::Background(double turn) {
  if (!background_.empty() && turn == turn_) return background_;
  Look(turn);
  background_ = cv::Mat(size_, CV_8UC3, theme_.back);
  cv::Mat depth(size_, CV_32F, cv::Scalar(std::numeric_limits<float>::max()));
  for (const Eigen::Vector3f& point : points_) {
    const auto at = Project(point.cast<double>());
    if (!at) continue;
    const cv::Point pixel(cvRound(at->x()), cvRound(at->y()));
    if (!cv::Rect({}, size_).contains(pixel) || depth.at<float>(pixel) <= static_cast<float>(at->z()))
      continue;
    depth.at<float>(pixel) = static_cast<float>(at->z());
    const cv::Rect dot = cv::Rect(pixel, cv::Size(dot_, dot_)) & cv::Rect({}, size_);
    background_(dot).setTo(ColorAt(point.z()));
  }
  return background_;
}

void MapPainter::Line(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const cv::Scalar& color, int width,
                      cv::Mat* picture) const {
  const auto from = Project(a), to = Project(b);
  if (!from || !to) return;
  const auto limited = [](double v) { return cvRound(std::clamp(v, -20000.0, 20000.0)); };
  cv::line(*picture, {limited(from->x()), limited(from->y())}, {limited(to->x()), limited(to->y())}, color,
           width, cv::LINE_AA);
}

}  // namespace evit::render
