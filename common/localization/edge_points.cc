#include "common/localization/edge_points.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace evit {
namespace {

constexpr double kLine = 0.75;     // share of the spread that lies along the principal direction of a line
constexpr int kFewest = 4;         // neighbours
constexpr std::size_t kMost = 64;  // neighbours that are looked at: a bundle of thousands says no more
constexpr int kBits = 21;          // of a cube's coordinate in a key

using Key = std::uint64_t;

Key KeyOf(const Eigen::Vector3f& p, double size, const Eigen::Vector3i& shift = Eigen::Vector3i::Zero()) {
  Key key = 0;
  for (int a = 0; a < 3; ++a) {
    const auto cube = static_cast<std::int64_t>(std::floor(p[a] / size)) + shift[a];
    key = key << kBits | (static_cast<Key>(cube + (1LL << (kBits - 1))) & ((1ULL << kBits) - 1));
  }
  return key;
}

using Keyed = std::vector<std::pair<Key, std::int32_t>>;

Keyed SortedByCube(const std::vector<Eigen::Vector3f>& points, double size) {
  Keyed keyed;
  keyed.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    keyed.emplace_back(KeyOf(points[k], size), static_cast<std::int32_t>(k));
  std::sort(keyed.begin(), keyed.end());
  return keyed;
}

// The map's points in cubes, to look for neighbours in.
class Neighbours {
 public:
  Neighbours(const PointMap& map, double radius)
      : map_(map), radius_(static_cast<float>(radius)), keyed_(SortedByCube(map.points, radius)) {}

  Eigen::Vector3f DirectionAt(const Eigen::Vector3f& at) const {
    std::vector<Eigen::Vector3f> near;
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) Collect(at, {dx, dy, dz}, &near);
    if (near.size() < kFewest) return Eigen::Vector3f::Zero();
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (const Eigen::Vector3f& p : near) mean += p / static_cast<float>(near.size());
    Eigen::Matrix3f spread = Eigen::Matrix3f::Zero();
    for (const Eigen::Vector3f& p : near) spread += (p - mean) * (p - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> axes(spread);
    if (!(axes.eigenvalues()[2] > kLine * spread.trace())) return Eigen::Vector3f::Zero();
    return axes.eigenvectors().col(2);
  }

 private:
  void Collect(const Eigen::Vector3f& at, const Eigen::Vector3i& shift,
               std::vector<Eigen::Vector3f>* near) const {
    const Key key = KeyOf(at, radius_, shift);
    const auto begin = std::lower_bound(keyed_.begin(), keyed_.end(), std::make_pair(key, std::int32_t{0}));
    auto end = begin;
    while (end != keyed_.end() && end->first == key) ++end;
    const std::ptrdiff_t stride =
        std::max<std::ptrdiff_t>(1, (end - begin) / static_cast<std::ptrdiff_t>(kMost));
    for (auto it = begin; it < end; it += std::min(stride, std::max<std::ptrdiff_t>(1, end - it))) {
      const Eigen::Vector3f& p = map_.points[it->second];
      if ((p - at).squaredNorm() < radius_ * radius_) near->push_back(p);
    }
  }

  const PointMap& map_;
  float radius_;
  Keyed keyed_;
};

}  // namespace

std::vector<EdgePoint> ThinEdges(const PointMap& map, const EdgePointOptions& options) {
  std::vector<std::int32_t> kept;
  for (double spacing = options.spacing;; spacing *= 1.25) {
    const Keyed keyed = SortedByCube(map.points, spacing);
    kept.clear();
    for (std::size_t k = 0; k < keyed.size(); ++k)
      if (k == 0 || keyed[k].first != keyed[k - 1].first) kept.push_back(keyed[k].second);
    if (kept.size() <= options.max_points) break;
  }
  std::sort(kept.begin(), kept.end());
  const Neighbours neighbours(map, options.radius);
  std::vector<EdgePoint> edges;
  edges.reserve(kept.size());
  for (const std::int32_t id : kept)
    edges.push_back({map.points[id], neighbours.DirectionAt(map.points[id])});
  return edges;
}

}  // namespace evit
