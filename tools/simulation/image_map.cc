#include "tools/simulation/image_map.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "tools/simulation/edge_pixels.h"
#include "tools/simulation/grey_image.h"
#include "tools/simulation/random.h"

namespace evit::simulation {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr int kViewsAlike = 3;  // views that are matched with each other and so err together

// Of the piece of an edge at a place of the map.
Random RandomOfPiece(const Eigen::Vector3d& point, double piece_m, std::uint64_t seed, std::uint64_t stream) {
  std::uint64_t key = stream;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::int64_t>(std::floor(point[axis] / piece_m));
    key = (key << 20) ^ (static_cast<std::uint64_t>(cell) & 0xFFFFF);
  }
  return Random(seed ^ 0x91ECE, key);
}

}  // namespace

Camera ScaledCamera(const Camera& camera, double scale) {
  Camera scaled = camera;
  scaled.width = std::max(16, static_cast<int>(std::lround(scale * camera.width)));
  scaled.height = std::max(16, static_cast<int>(std::lround(scale * camera.height)));
  scaled.fx *= scale;
  scaled.fy *= scale;
  scaled.cx = scale * (camera.cx + 0.5) - 0.5;
  scaled.cy = scale * (camera.cy + 0.5) - 0.5;
  return scaled;
}

std::vector<Eigen::Vector3d> PointsOfImage(const Renderer& renderer, const SE3& T_map_camera,
                                           const Eigen::Vector3d& velocity, const ImageMapSettings& settings,
                                           std::uint64_t seed, int view) {
  const Camera& camera = renderer.camera();
  Random random(seed, 0x13A9E000 + static_cast<std::uint64_t>(view));
  View image;
  renderer.Render(T_map_camera, &image);
  const SE3 believed(T_map_camera.q * ExpSO3(settings.view_turn_deg * kDegree * random.GaussianVector()),
                     T_map_camera.p + settings.view_move_m * random.GaussianVector());
  const Eigen::Vector3d baseline = T_map_camera.q.conjugate() * velocity;
  const double parallel = std::sin(settings.parallel_deg * kDegree);
  const double match = settings.match_px / (camera.fx * settings.baseline_m);  // 1/m, of the inverse depth
  const auto group = static_cast<std::uint64_t>(view / kViewsAlike);
  std::vector<Eigen::Vector3d> points;
  for (const EdgePixel& edge :
       FindEdgesIn(GreyImage(image.image, camera, settings.gamma, settings.grey_noise, &random), image,
                   settings.grey_threshold)) {
    Eigen::Vector3d ray;
    if (!camera.Unproject(edge.pixel, &ray)) continue;
    const Eigen::Vector2d epipolar = baseline.z() * ray.head<2>() - baseline.head<2>();
    if (std::abs(epipolar.dot(edge.normal)) < parallel * epipolar.norm()) continue;
    const Eigen::Vector3d there = T_map_camera * (ray / edge.inverse_depth);
    if (RandomOfPiece(there, settings.piece_m, seed, 0).Chance(settings.missing_share)) continue;
    const double error = match * RandomOfPiece(there, settings.piece_m, seed, 1 + group).Gaussian();
    const double inverse_depth = edge.inverse_depth + error;
    if (inverse_depth > 0.3 * edge.inverse_depth) points.push_back(believed * (ray / inverse_depth));
  }
  return points;
}

}  // namespace evit::simulation
