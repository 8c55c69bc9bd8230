#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/se3.h"

namespace evit {

/// A scene of flat rectangles, each of one grey, before a grey backdrop: its pictures and its edges are known
/// exactly.
class PaintedScene {
 public:
  struct Rectangle {
    Eigen::Vector3d corner, u, v;  // u and v: sides, at a right angle
    double grey;
  };

  /// A wall 2 m ahead (along y, z up) with dark and bright patches, and a board 1.3 m ahead.
  static PaintedScene Wall() {
    PaintedScene scene;
    scene.Add({-1.5, 2.0, -1.2}, {3, 0, 0}, {0, 0, 2.4}, 120);
    const auto patch = [&](double x, double z, double width, double height, double grey) {
      scene.Add({x, 1.999, z}, {width, 0, 0}, {0, 0, height}, grey);
    };
    patch(-0.75, -0.45, 0.35, 0.25, 30);
    patch(-0.65, 0.10, 0.22, 0.30, 230);
    patch(0.35, 0.15, 0.30, 0.22, 25);
    patch(0.30, -0.50, 0.25, 0.35, 220);
    patch(-0.15, 0.42, 0.30, 0.12, 40);
    scene.Add({-0.2, 1.3, -0.2}, {0.28, 0.05, 0.06}, {-0.05, 0, 0.3}, 60);
    return scene;
  }

  /// Cameras that look ahead (along y) from a few places, some centimetres apart, up to `width` m.
  static std::vector<SE3> Poses(int n, double width) {
    std::vector<SE3> poses;
    for (int k = 0; k < n; ++k) {
      const double s = n > 1 ? k / (n - 1.0) - 0.5 : 0;
      const Eigen::Matrix3d ahead = (Eigen::Matrix3d() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();
      const Eigen::Quaterniond turned = Eigen::Quaterniond(ahead) *
                                        Eigen::AngleAxisd(0.1 * s, Eigen::Vector3d::UnitY()) *
                                        Eigen::AngleAxisd(0.05 * std::sin(9 * s), Eigen::Vector3d::UnitZ());
      poses.push_back({turned, {width * s, 0.1 * width * std::cos(5 * s), 0.5 * width * std::sin(6 * s)}});
    }
    return poses;
  }

  void Add(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v, double grey) {
    rectangles_.push_back({corner, u, v, grey});
  }

  /// CV_8UC1, each pixel the mean of 3 x 3 rays.
  cv::Mat Picture(const Camera& camera, const SE3& T_map_camera) const {
    cv::Mat picture(camera.height, camera.width, CV_8U);
    for (int row = 0; row < camera.height; ++row) {
      for (int column = 0; column < camera.width; ++column) {
        double sum = 0;
        for (int k = 0; k < 9; ++k) {
          const int across = k % 3 - 1, down = k / 3 - 1;
          Eigen::Vector3d ray;
          camera.Unproject({column + across / 3.0, row + down / 3.0}, &ray);
          sum += Grey(T_map_camera.p, T_map_camera.q * ray);
        }
        picture.at<std::uint8_t>(row, column) = static_cast<std::uint8_t>(std::lround(sum / 9));
      }
    }
    return picture;
  }

  /// CV_16UC1, `units` per metre along the optical axis, 0 where there is nothing: what a depth camera sees.
  cv::Mat Depth(const Camera& camera, const SE3& T_map_camera, double units) const {
    cv::Mat picture(camera.height, camera.width, CV_16U);
    for (int row = 0; row < camera.height; ++row) {
      for (int column = 0; column < camera.width; ++column) {
        Eigen::Vector3d ray;
        camera.Unproject({static_cast<double>(column), static_cast<double>(row)}, &ray);
        const double z = Hit(T_map_camera.p, T_map_camera.q * ray).along;
        picture.at<std::uint16_t>(row, column) =
            static_cast<std::uint16_t>(z < 60 ? std::lround(z * units) : 0);
      }
    }
    return picture;
  }

  /// m, of a place to the nearest side of a rectangle.
  double DistanceToEdge(const Eigen::Vector3d& p) const {
    double best = std::numeric_limits<double>::max();
    for (const Rectangle& r : rectangles_) {
      for (const auto& [from, along] : {std::make_pair(r.corner, r.u), std::make_pair(r.corner, r.v),
                                        std::make_pair(Eigen::Vector3d(r.corner + r.u), r.v),
                                        std::make_pair(Eigen::Vector3d(r.corner + r.v), r.u)}) {
        const double s = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
        best = std::min(best, (from + s * along - p).norm());
      }
    }
    return best;
  }

  const std::vector<Rectangle>& rectangles() const { return rectangles_; }

  /// 0..255, of what a ray first meets.
  double Grey(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) const { return Hit(from, ray).grey; }

 private:
  struct Met {
    double grey = 120, along = std::numeric_limits<double>::max();  // in lengths of the ray
  };
  Met Hit(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) const {
    Met met;
    for (const Rectangle& r : rectangles_) {
      const Eigen::Vector3d normal = r.u.cross(r.v);
      const double s = normal.dot(r.corner - from) / normal.dot(ray);
      if (!(s > 0) || s >= met.along) continue;
      const Eigen::Vector3d at = from + s * ray - r.corner;
      const double a = at.dot(r.u) / r.u.squaredNorm(), b = at.dot(r.v) / r.v.squaredNorm();
      if (a < 0 || a > 1 || b < 0 || b > 1) continue;
      met = {r.grey, s};
    }
    return met;
  }

  std::vector<Rectangle> rectangles_;
};

}  // namespace evit
