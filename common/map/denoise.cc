#include "common/map/denoise.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace evit {
namespace {

/// Points by cells of a grid as wide as the radius.
class Neighbours {
 public:
  Neighbours(const std::vector<Eigen::Vector3f>& points, double radius)
      : points_(points), inverse_(1 / radius), radius2_(static_cast<float>(radius * radius)) {
    cells_.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) cells_.emplace_back(Key(Cell(points[i])), i);
    std::sort(cells_.begin(), cells_.end());
  }

  /// Calls visit(index, point, squared distance, how many it stands for) for all within the radius of `p`; of
  /// a crowd for an even part.
  template <typename Visit>
  void ForEach(const Eigen::Vector3f& p, Visit visit) const {
    const std::array<std::int64_t, 3> at = Cell(p);
    for (std::int64_t x = -1; x <= 1; ++x) {
      for (std::int64_t y = -1; y <= 1; ++y) {
        // Three cells along z follow each other.
        const std::uint64_t first = Key({at[0] + x, at[1] + y, at[2] - 1}),
                            last = Key({at[0] + x, at[1] + y, at[2] + 1});
        const auto begin =
            std::lower_bound(cells_.begin(), cells_.end(), std::make_pair(first, std::size_t{0}));
        const auto end = std::lower_bound(begin, cells_.end(), std::make_pair(last + 1, std::size_t{0}));
        // A crowd is asked in part: the time must not grow with its square.
        const auto step = 1 + (end - begin) / kCrowd;
        for (auto it = begin; it < end; it += std::min(step, end - it)) {
          const float d2 = (points_[it->second] - p).squaredNorm();
          if (d2 <= radius2_) visit(it->second, points_[it->second], d2, step);
        }
      }
    }
  }

 private:
  static constexpr std::ptrdiff_t kCrowd = 96;  // points in three cells

  std::array<std::int64_t, 3> Cell(const Eigen::Vector3f& p) const {
    constexpr double kFarthest = (1 << 20) - 2;  // cells from the origin: beyond, points share the last one
    std::array<std::int64_t, 3> cell{};
    for (int k = 0; k < 3; ++k)
      cell[k] = static_cast<std::int64_t>(std::floor(std::clamp(p[k] * inverse_, -kFarthest, kFarthest)));
    return cell;
  }
  // 21 bits each, the sign moved out of the way: neighbours along z have neighbouring keys.
  static std::uint64_t Key(const std::array<std::int64_t, 3>& cell) {
    std::uint64_t key = 0;
    for (const std::int64_t c : cell)
      key = (key << 21) | (static_cast<std::uint64_t>(c + (1 << 20)) & 0x1FFFFF);
    return key;
  }

  const std::vector<Eigen::Vector3f>& points_;
  double inverse_;
  float radius2_;
  std::vector<std::pair<std::uint64_t, std::size_t>> cells_;
};

Eigen::Vector3f OntoLine(const Neighbours& neighbours, const Eigen::Vector3f& p, std::size_t self,
                         double sigma, std::int64_t* n) {
  // Relative to p: single precision loses nothing where the map is large.
  double weight = 1;  // of p itself
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  *n = 1;
  neighbours.ForEach(p, [&](std::size_t i, const Eigen::Vector3f& q, float d2, std::ptrdiff_t count) {
    if (i == self) return;
    const double w = static_cast<double>(count) * std::exp(-0.5 * d2 / (sigma * sigma));
    const Eigen::Vector3d d = (q - p).cast<double>();
    weight += w;
    mean += w * d;
    square += w * d * d.transpose();
    *n += count;
  });
  mean /= weight;
  const Eigen::Matrix3d covariance = square / weight - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3d along = solver.eigenvectors().col(2);
  return p + (mean - along * along.dot(mean)).cast<float>();
}

}  // namespace

DenoiseSummary Denoise(const DenoiseSettings& settings, PointMap* map) {
  DenoiseSummary summary;
  if (map->points.empty() || settings.radius <= 0) return summary;
  const Neighbours neighbours(map->points, settings.radius);
  std::vector<Eigen::Vector3f> moved(map->points.size());
  std::vector<std::int64_t> n(map->points.size());
  for (std::size_t i = 0; i < moved.size(); ++i)
    moved[i] = OntoLine(neighbours, map->points[i], i, settings.radius / 2, &n[i]);
  std::vector<std::int64_t> sorted = n;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const bool dense = static_cast<double>(sorted[sorted.size() / 2]) >= settings.min_usual_neighbours;
  const auto vouched = [&](std::size_t i) { return n[i] >= settings.min_neighbours; };
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (!vouched(i)) continue;
    map->points[i] = moved[i];
    ++summary.n_moved;
  }
  if (dense) KeepIf(map, vouched);
  summary.n_dropped = moved.size() - map->points.size();
  return summary;
}

}  // namespace evit
