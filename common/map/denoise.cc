#include "common/map/denoise.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/simd/lanes.h"

namespace evit {
namespace {

// A block of neighbours is tested at once; what lies within the radius is a fraction of them.
EVIT_MULTIVERSION void SquaredDistances(const float* __restrict x, const float* __restrict y,
                                        const float* __restrict z, std::size_t n, const float* p,
                                        float* __restrict out) {
  for (std::size_t k = 0; k < n; ++k) {
    const float dx = x[k] - p[0], dy = y[k] - p[1], dz = z[k] - p[2];
    out[k] = dx * dx + (dy * dy + dz * dz);
  }
}

/// Points by cells of a grid as wide as the radius, in the order of their cells.
class Neighbours {
 public:
  Neighbours(const std::vector<Eigen::Vector3f>& points, double radius)
      : points_(points), inverse_(1 / radius), radius2_(static_cast<float>(radius * radius)) {
    cells_.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) cells_.emplace_back(Key(Cell(points[i])), i);
    std::sort(cells_.begin(), cells_.end());
  }

  /// Calls visit(index) for each point, cell by cell, and gathers what is around a cell once for all its
  /// points.
  template <typename Visit>
  void ForEachPoint(Visit visit) {
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      if (k == 0 || cells_[k].first != cells_[k - 1].first) Gather(Cell(points_[cells_[k].second]));
      visit(cells_[k].second);
    }
  }

  /// Calls visit(index, point, squared distance, how many it stands for) for all within the radius of `p`, a
  /// point of the cell that ForEachPoint() is at; of a crowd for an even part.
  template <typename Visit>
  void ForEachNear(const Eigen::Vector3f& p, Visit visit) {
    distances_.resize(around_.size());
    SquaredDistances(x_.data(), y_.data(), z_.data(), around_.size(), p.data(), distances_.data());
    for (std::size_t k = 0; k < around_.size(); ++k) {
      if (distances_[k] > radius2_) continue;
      visit(around_[k].index, Eigen::Vector3f(x_[k], y_[k], z_[k]), distances_[k], around_[k].count);
    }
  }

 private:
  static constexpr std::ptrdiff_t kCrowd = 96;  // points in three cells
  struct Around {
    std::size_t index;
    std::ptrdiff_t count;
  };

  void Gather(const std::array<std::int64_t, 3>& at) {
    around_.clear(), x_.clear(), y_.clear(), z_.clear();
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
          const Eigen::Vector3f& q = points_[it->second];
          around_.push_back({it->second, step});
          x_.push_back(q.x()), y_.push_back(q.y()), z_.push_back(q.z());
        }
      }
    }
  }

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
  std::vector<Around> around_;  // the cell that ForEachPoint() is at
  std::vector<float> x_, y_, z_, distances_;
};

Eigen::Vector3f OntoLine(Neighbours* neighbours, const Eigen::Vector3f& p, std::size_t self, double sigma,
                         std::int64_t* n) {
  // Relative to p: single precision loses nothing where the map is large.
  double weight = 1;  // of p itself
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  *n = 1;
  neighbours->ForEachNear(p, [&](std::size_t i, const Eigen::Vector3f& q, float d2, std::ptrdiff_t count) {
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
  Neighbours neighbours(map->points, settings.radius);
  std::vector<Eigen::Vector3f> moved(map->points.size());
  std::vector<std::int64_t> n(map->points.size());
  neighbours.ForEachPoint([&](std::size_t i) {
    moved[i] = OntoLine(&neighbours, map->points[i], i, settings.radius / 2, &n[i]);
  });
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
