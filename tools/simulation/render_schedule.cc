#include "tools/simulation/render_schedule.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/parallel_for.h"

namespace evit::simulation {
namespace {

constexpr Utime kInterval = 10'000;                // between speed estimates
constexpr double kMinStep = 200, kMaxStep = 5000;  // us

struct SpeedSample {
  double p95 = 0, depth = 0;
};

// Moves points seen through a grid of pixels by the motion of 1 ms and projects them again.
SpeedSample MeasureSpeed(const PoseSpline& motion, const Rig& rig, const Scene& scene, Utime t) {
  constexpr int kColumns = 12, kRows = 9;
  const Utime later = std::min(t + 1000, motion.end()), earlier = later - 1000;
  const SE3 T_map_camera = motion.Pose(earlier) * rig.T_body_camera;
  const SE3 T_next_map = (motion.Pose(later) * rig.T_body_camera).Inverse();
  const Eigen::Matrix3d R = T_map_camera.R();
  std::vector<double> speeds;
  double depth = 0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const Eigen::Vector2d pixel((column + 0.5) / kColumns * rig.camera.width,
                                  (row + 0.5) / kRows * rig.camera.height);
      Eigen::Vector3d ray;
      if (!rig.camera.Unproject(pixel, &ray)) continue;
      const Hit hit = CastRay(scene, T_map_camera.p, R * ray);
      Eigen::Vector2d moved;
      if (hit.surface < 0 || !rig.camera.Project(T_next_map * (T_map_camera * (hit.depth * ray)), &moved))
        continue;
      speeds.push_back((moved - pixel).norm() * 1e3);
      depth += hit.depth;
    }
  }
  if (speeds.empty()) return {};
  const auto p95 = speeds.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(speeds.size()));
  depth /= static_cast<double>(speeds.size());
  std::nth_element(speeds.begin(), p95, speeds.end());
  return {*p95, depth};
}

}  // namespace

RenderSchedule PlanRenders(const PoseSpline& motion, const Rig& rig, const Scene& scene, Utime begin,
                           Utime end, double max_step_px, int threads) {
  const int n = static_cast<int>((end - begin) / kInterval) + 2;
  std::vector<SpeedSample> samples(n);
  ParallelFor(n, threads, [&](int i) {
    samples[i] = MeasureSpeed(motion, rig, scene, std::min(begin + i * kInterval, end));
  });
  RenderSchedule schedule;
  std::vector<double> sorted;
  for (const SpeedSample& sample : samples) {
    sorted.push_back(sample.p95);
    schedule.speed.mean += sample.p95 / n;
    schedule.mean_depth += sample.depth / n;
  }
  std::sort(sorted.begin(), sorted.end());
  schedule.speed.median = sorted[n / 2];
  schedule.speed.p95 = sorted[static_cast<std::size_t>(0.95 * n)];
  schedule.speed.max = sorted.back();

  Utime t = begin;
  while (true) {
    schedule.times.push_back(t);
    if (t >= end) break;
    // The faster of the two neighbours, so that a step never starts too long.
    const std::size_t i = (t - begin) / kInterval;
    const double speed = std::max({samples[i].p95, samples[i + 1].p95, 1e-3});
    t += static_cast<Utime>(std::clamp(1e6 * max_step_px / speed, kMinStep, kMaxStep));
    t = std::min(t, end);
  }
  return schedule;
}

}  // namespace evit::simulation
