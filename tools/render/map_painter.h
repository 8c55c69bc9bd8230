#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "common/geometry/se3.h"

namespace evit::render {

/// Colours of a picture, BGR.
struct Theme {
  cv::Scalar back, ink, soft, accent, low, middle, high;
};
Theme LightTheme();
Theme DarkTheme();

/// A map seen in perspective from outside or above: points coloured by height, and lines over them.
class MapPainter {
 public:
  /// `points`: map frame, m. `turn`: rad, of the view about the vertical.
  MapPainter(std::vector<Eigen::Vector3f> points, cv::Size size, double turn, const Theme& theme);

  /// The points, from here on the background of Line(). The same picture again unless `turn` has changed.
  const cv::Mat& Background(double turn);
  /// A line between points of the map, m; parts behind the viewer are left out.
  void Line(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const cv::Scalar& color, int width,
            cv::Mat* picture) const;

 private:
  void Frame();
  void Look(double turn);
  std::optional<Eigen::Vector3d> Project(const Eigen::Vector3d& point) const;
  cv::Vec3b ColorAt(float height) const;

  std::vector<Eigen::Vector3f> points_;
  cv::Size size_;
  Theme theme_;
  Eigen::Vector3d center_;  // of the map without its strays, m
  double radius_ = 1;       // m
  float low_ = 0, high_ = 1;
  double turn_, focal_ = 1;
  int dot_ = 1;  // pixels
  SE3 T_view_map_;
  cv::Mat background_;
};

}  // namespace evit::render
