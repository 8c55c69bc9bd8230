#include "common/photometric/rgbd_fusion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace evit {
namespace {

constexpr std::int64_t kOffset = 1 << 20;  // voxels: a map reaches 12 km each way at 12 mm

// 21 bits for each axis; order of the keys is order in space.
std::uint64_t KeyOf(const Eigen::Vector3d& p, double voxel) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::int64_t>(std::floor(p[axis] / voxel)) + kOffset;
    key = key << 21 | static_cast<std::uint64_t>(std::clamp<std::int64_t>(cell, 0, 2 * kOffset - 1));
  }
  return key;
}

}  // namespace

void RgbdFusion::Add(const RgbdView& view) {
  const Camera& camera = view.camera;
  const std::size_t n = static_cast<std::size_t>(camera.width) * camera.height;
  if (view.intensity.size() != n || view.depth.size() != n) {
    throw std::invalid_argument("an RGB-D view's images are not of its camera's size");
  }
  const Eigen::Matrix3d R = view.T_map_camera.R();
  for (int y = 1; y + 1 < camera.height; ++y) {
    for (int x = 1; x + 1 < camera.width; ++x) {
      const std::size_t k = static_cast<std::size_t>(y) * camera.width + x;
      const auto inverse = [&](std::ptrdiff_t step) {
        const float depth = view.depth[k + step];
        return depth > 0 ? 1.0 / depth : 0.0;
      };
      const double depth = view.depth[k];
      if (!(depth >= settings_.min_depth && depth <= settings_.max_depth)) continue;
      // The inverse depth of a plane is linear over the image, however slanted it is.
      const double rho = inverse(0), most = settings_.max_bend * rho;
      const auto bend = [&](std::ptrdiff_t step) {
        const double a = inverse(-step), b = inverse(step);
        return a > 0 && b > 0 ? std::abs(a + b - 2 * rho) : 2 * most;
      };
      if (bend(1) > most || bend(camera.width) > most) continue;
      const Eigen::Vector3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
      const Eigen::Vector3d p = R * (depth * ray) + view.T_map_camera.p;
      const double weight = rho * rho;
      Voxel& voxel = voxels_[KeyOf(p, settings_.voxel)];
      voxel.position += weight * p;
      voxel.intensity += weight * view.intensity[k];
      voxel.weight += weight;
    }
  }
}

PhotometricMap RgbdFusion::Finish() const {
  std::vector<std::pair<std::uint64_t, const Voxel*>> ordered;
  ordered.reserve(voxels_.size());
  for (const auto& [key, voxel] : voxels_) ordered.emplace_back(key, &voxel);
  std::sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  PhotometricMap map;
  map.points.reserve(ordered.size());
  map.intensities.reserve(ordered.size());
  for (const auto& [key, voxel] : ordered) {
    map.points.push_back((voxel->position / voxel->weight).cast<float>());
    map.intensities.push_back(static_cast<float>(voxel->intensity / voxel->weight));
  }
  return map;
}

}  // namespace evit
