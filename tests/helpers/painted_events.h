#pragma once

#include <cmath>
#include <vector>

#include "common/events/event.h"
#include "tests/helpers/painted_scene.h"

namespace evit {

/// Cameras on a circle of `radius` m before the scene, all looking ahead, once around at an even speed.
inline std::vector<SE3> CircleOfPoses(int n, double radius) {
  const SE3 ahead = PaintedScene::Poses(1, 0)[0];
  std::vector<SE3> poses;
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * M_PI * k / n;
    poses.push_back({ahead.q, ahead.p + radius * Eigen::Vector3d(std::cos(angle), 0, std::sin(angle))});
  }
  return poses;
}

/// What an event camera with these poses, `step` us apart and the first at `begin`, sees of a painted scene:
/// an event for each `threshold` of log intensity since the pixel's last one, stamped between the poses.
inline EventArray PaintedEvents(const PaintedScene& scene, const Camera& camera,
                                const std::vector<SE3>& poses, Utime begin, Utime step,
                                double threshold = 0.4) {
  constexpr int kRays = 2;  // of a pixel, each way
  std::vector<Eigen::Vector3d> rays;
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      for (int k = 0; k < kRays * kRays; ++k) {
        const int across = k % kRays, down = k / kRays;
        Eigen::Vector3d ray;
        camera.Unproject({column + (across + 0.5) / kRays - 0.5, row + (down + 0.5) / kRays - 0.5}, &ray);
        rays.push_back(ray);
      }
    }
  }
  const std::size_t n = static_cast<std::size_t>(camera.width) * camera.height;
  std::vector<double> level(n);
  EventArray events;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Eigen::Matrix3d R = poses[k].R();
    for (std::size_t i = 0; i < n; ++i) {
      double grey = 0;
      for (int r = 0; r < kRays * kRays; ++r)
        grey += scene.Grey(poses[k].p, R * rays[i * kRays * kRays + r]) / (kRays * kRays);
      const double now = std::log(grey);
      if (k == 0) level[i] = now;
      while (std::abs(now - level[i]) >= threshold) {
        const bool brighter = now > level[i];
        level[i] += brighter ? threshold : -threshold;
        events.push_back(begin + static_cast<Utime>(k) * step - step / 2,
                         static_cast<std::uint16_t>(i % camera.width),
                         static_cast<std::uint16_t>(i / camera.width), brighter ? 1 : 0);
      }
    }
  }
  return events;
}

}  // namespace evit
