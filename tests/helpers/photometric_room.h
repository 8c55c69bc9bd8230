#pragma once

// For tests only: a room of two patterned walls, what a camera sees of it, a photometric map of it and the
// events of a motion through it, all by definition rather than by the code under test.
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "common/geometry/camera.h"
#include "common/map/photometric_map.h"
#include "common/photometric/photometric_view.h"

namespace evit::test {

/// Walls x = 3 and, nearer, y = -1.2 (x from 1 to 3), seen from around the origin; z up. Moved by T_map_room.
struct Room {
  SE3 T_map_room;
  double phase = 0;  // another one: other patterns on the walls
  static constexpr double kDark = 0.012;

  double Intensity(const Eigen::Vector3d& place) const {  // 0..1, place in the room
    const Eigen::Vector3d p = (1 + 0.4 * phase) * place;
    const double wave = std::sin(7.1 * p.y() + 2.3 * p.z() + 3 * p.x() + phase) +
                        std::sin(-3.7 * p.y() + 8.9 * p.z() + 5 * p.x() + 1 + 2 * phase) +
                        std::sin(13.3 * p.y() - 9.1 * p.z() - 8 * p.x() + 2 + 3 * phase);
    return 0.5 + 0.45 * std::tanh(1.5 * wave);
  }
  /// Where a ray from `origin` meets a wall, as a multiple of `direction` (both in the room); 0: nowhere.
  static double Cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    double nearest = 0;
    if (direction.x() > 0) {
      const double s = (3 - origin.x()) / direction.x();
      const Eigen::Vector3d p = origin + s * direction;
      if (s > 0 && std::abs(p.y()) < 4 && std::abs(p.z()) < 3) nearest = s;
    }
    if (direction.y() < 0) {
      const double s = (-1.2 - origin.y()) / direction.y();
      const Eigen::Vector3d p = origin + s * direction;
      if (s > 0 && p.x() > 1 && p.x() < 3 && std::abs(p.z()) < 3 && (nearest <= 0 || s < nearest))
        nearest = s;
    }
    return nearest > 0 && nearest < 20 ? nearest : 0;
  }
  /// Ray by ray; distortion allowed.
  PhotometricView See(const Camera& camera, const SE3& T_map_camera) const {
    PhotometricView view;
    view.query.camera = camera;
    view.query.T_map_camera = T_map_camera;
    const SE3 T = T_map_room.Inverse() * T_map_camera;
    const Eigen::Matrix3d R = T.R();
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        Eigen::Vector3d ray;
        double depth = 0;
        if (camera.Unproject(Eigen::Vector2d(x, y), &ray)) depth = Cast(T.p, R * ray);
        view.inverse_depth.push_back(depth > 0 ? static_cast<float>(1 / depth) : 0);
        view.log_intensity.push_back(
            depth > 0 ? static_cast<float>(std::log(Intensity(T * (depth * ray)) + kDark)) : 0);
      }
    }
    return view;
  }
  PhotometricMap Map(double spacing) const {
    PhotometricMap map;
    const auto add = [&](const Eigen::Vector3d& p) {
      map.points.push_back((T_map_room * p).cast<float>());
      map.intensities.push_back(static_cast<float>(Intensity(p)));
    };
    for (double z = -3; z < 3; z += spacing) {
      for (double y = -4; y < 4; y += spacing) add({3, y, z});
      for (double x = 1; x < 3; x += spacing) add({x, -1.2, z});
    }
    return map;
  }
};

/// Camera along the body's x axis.
inline SE3 BodyCamera() {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Eigen::Quaterniond(R), {0.05, 0.01, 0.02}};
}

inline Camera EventCamera(int width = 320, int height = 240) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = 0.51 * width;
  camera.cx = 0.48 * width;
  camera.cy = 0.49 * height;
  camera.distortion = {-0.032, 0.042, -5e-4, -1e-3, 0};
  return camera;
}

/// Signed counts (as EventCounter's) of a pixel array that saw `before`, then `after`: each has its own phase
/// between two thresholds.
inline cv::Mat CountBetween(const PhotometricView& before, const PhotometricView& after, double threshold) {
  const Camera& camera = before.query.camera;
  cv::Mat counts(camera.height, camera.width, CV_8UC1);
  for (std::size_t k = 0; k < before.log_intensity.size(); ++k) {
    const double phase = static_cast<double>(k * 2'654'435'761U % 1000) / 1000;
    const double change = (after.log_intensity[k] - before.log_intensity[k]) / threshold;
    counts.data[k] =
        static_cast<unsigned char>(std::min(255.0, std::max(1.0, 128 + std::floor(change + phase))));
  }
  return counts;
}

}  // namespace evit::test
