#include "tools/simulation/edge_map.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "common/geometry/degrees.h"
#include "common/parallel/parallel_for.h"
#include "tools/simulation/image_map.h"
#include "tools/simulation/random.h"

namespace evit::simulation {
namespace {

Random RandomOfView(std::uint64_t seed, int i) {
  return Random(seed, 0x3A90000 + static_cast<std::uint64_t>(i));
}

Eigen::Vector3d DrawMisplacement(const MapSettings& settings, Random* random) {
  return settings.view_jitter_m * random->GaussianVector();
}

std::vector<Eigen::Vector3d> PointsOfView(const Renderer& renderer, const SE3& T_map_camera,
                                          const MapSettings& settings, Random random) {
  View view;
  renderer.Render(T_map_camera, &view);
  const Camera& camera = renderer.camera();
  const Eigen::Vector3d misplaced = DrawMisplacement(settings, &random);
  std::vector<Eigen::Vector3d> points;
  for (const EdgePixel& edge : FindEdges(view, camera.width, camera.height, settings.edge_threshold)) {
    const Eigen::Vector2d pixel = edge.pixel + settings.edge_noise_px * random.Gaussian() * edge.normal;
    const double depth = (1 + settings.depth_noise * random.Gaussian()) / edge.inverse_depth;
    Eigen::Vector3d ray, moved = Eigen::Vector3d::Zero();
    if (random.Chance(settings.outlier_share)) moved = settings.outlier_m * random.Direction();
    if (camera.Unproject(pixel, &ray)) points.push_back(T_map_camera * (depth * ray) + misplaced + moved);
  }
  return points;
}

}  // namespace

std::vector<Utime> ChooseMapViews(const PoseSpline& motion, Utime begin, Utime end,
                                  const MapSettings& settings) {
  std::vector<Utime> times;
  std::vector<SE3> poses;
  const auto step = std::max<Utime>(1000, static_cast<Utime>(settings.interval_s * 1e6));
  for (Utime t = begin; t <= end; t += step) {
    const SE3 pose = motion.Pose(t);
    const bool known = std::any_of(poses.begin(), poses.end(), [&](const SE3& p) {
      return (p.p - pose.p).norm() < settings.min_move_m &&
             AngularDistance(p.q, pose.q) * kDegreesPerRadian < settings.min_turn_deg;
    });
    if (known) continue;
    times.push_back(t);
    poses.push_back(pose);
  }
  return times;
}

Eigen::Vector3d ViewMisplacement(const MapSettings& settings, std::uint64_t seed, int i) {
  Random random = RandomOfView(seed, i);
  return DrawMisplacement(settings, &random);
}

PointMap MakeEdgeMap(const Renderer& renderer, const Rig& rig, const PoseSpline& motion, Utime begin,
                     Utime end, const MapSettings& settings, std::uint64_t seed, int threads, int* n_views) {
  const std::vector<Utime> times = ChooseMapViews(motion, begin, end, settings);
  *n_views = static_cast<int>(times.size());
  std::vector<std::vector<Eigen::Vector3d>> points(times.size());
  const Renderer grey(ScaledCamera(rig.camera, settings.images.scale), renderer.scene());
  ParallelFor(*n_views, threads, [&](int i) {
    const SE3 T_map_camera = motion.Pose(times[i]) * rig.T_body_camera;
    points[i] = settings.images.on ? PointsOfImage(grey, T_map_camera, motion.Evaluate(times[i]).velocity,
                                                   settings.images, seed, i)
                                   : PointsOfView(renderer, T_map_camera, settings, RandomOfView(seed, i));
  });
  PointMap map;
  std::unordered_set<std::uint64_t> voxels;
  for (const auto& list : points) {
    for (const Eigen::Vector3d& p : list) {
      std::uint64_t key = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const auto cell = static_cast<std::int64_t>(std::floor(p[axis] / settings.voxel_m));
        key = (key << 21) | (static_cast<std::uint64_t>(cell) & 0x1FFFFF);
      }
      if (voxels.insert(key).second) map.points.push_back(p.cast<float>());
    }
  }
  Random random(seed, 0x5AFF1E);
  for (std::size_t i = map.points.size(); i > 1; --i) {
    std::swap(map.points[i - 1], map.points[random.Next() % i]);
  }
  if (map.points.size() > settings.max_points) map.points.resize(settings.max_points);
  return map;
}

}  // namespace evit::simulation
