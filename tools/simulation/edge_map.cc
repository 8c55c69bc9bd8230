#include "tools/simulation/edge_map.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <unordered_set>

#include "tools/simulation/event_sensor.h"
#include "tools/simulation/parallel.h"
#include "tools/simulation/random.h"

namespace evit::simulation {
namespace {

float Bilinear(const cv::Mat& image, double x, double y) {
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  const float *a = image.ptr<float>(y0) + x0, *b = image.ptr<float>(y0 + 1) + x0;
  return (1 - fy) * ((1 - fx) * a[0] + fx * a[1]) + fy * ((1 - fx) * b[0] + fx * b[1]);
}

// At a depth edge the border belongs to the nearer surface, though the pixel's centre may see the farther.
double NearestInverseDepth(const View& view, int width, int x, int y) {
  const std::size_t i = static_cast<std::size_t>(y) * width + x;
  const float centre = view.inverse_depth[i];
  float nearest = centre;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      nearest = std::max(nearest, view.inverse_depth[i + static_cast<std::ptrdiff_t>(dy) * width + dx]);
    }
  }
  return nearest > 1.03F * centre ? nearest : centre;
}

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
             AngularDistance(p.q, pose.q) * 57.2957795 < settings.min_turn_deg;
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

std::vector<EdgePixel> FindEdges(const View& view, int width, int height, double threshold) {
  cv::Mat log_image(height, width, CV_32F);
  for (std::size_t i = 0; i < view.image.size(); ++i) {
    log_image.ptr<float>()[i] = FastLog(view.image[i] + 3.0F);
  }
  cv::GaussianBlur(log_image, log_image, {5, 5}, 0.8);
  cv::Mat gx, gy, magnitude;
  cv::Sobel(log_image, gx, CV_32F, 1, 0, 3, 0.125);
  cv::Sobel(log_image, gy, CV_32F, 0, 1, 3, 0.125);
  cv::magnitude(gx, gy, magnitude);
  std::vector<EdgePixel> edges;
  constexpr int kBorder = 4;
  for (int y = kBorder; y < height - kBorder; ++y) {
    for (int x = kBorder; x < width - kBorder; ++x) {
      const double m = magnitude.at<float>(y, x);
      if (m < threshold) continue;
      const Eigen::Vector2d normal = Eigen::Vector2d(gx.at<float>(y, x), gy.at<float>(y, x)) / m;
      const double before = Bilinear(magnitude, x - normal.x(), y - normal.y());
      const double after = Bilinear(magnitude, x + normal.x(), y + normal.y());
      if (m < before || m <= after) continue;
      const double bend = before - 2 * m + after;  // of the parabola through the three: negative here
      const double offset = bend < -1e-9 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
      const double inverse_depth = NearestInverseDepth(view, width, x, y);
      if (inverse_depth > 0)
        edges.push_back({Eigen::Vector2d(x, y) + offset * normal, normal, inverse_depth});
    }
  }
  return edges;
}

PointMap MakeEdgeMap(const Renderer& renderer, const Rig& rig, const PoseSpline& motion, Utime begin,
                     Utime end, const MapSettings& settings, std::uint64_t seed, int threads, int* n_views) {
  const std::vector<Utime> times = ChooseMapViews(motion, begin, end, settings);
  *n_views = static_cast<int>(times.size());
  std::vector<std::vector<Eigen::Vector3d>> points(times.size());
  ParallelFor(*n_views, threads, [&](int i) {
    points[i] =
        PointsOfView(renderer, motion.Pose(times[i]) * rig.T_body_camera, settings, RandomOfView(seed, i));
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
