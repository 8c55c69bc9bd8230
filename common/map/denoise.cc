#include "common/map/denoise.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/map/near_points.h"
#include "common/simd/lanes.h"

namespace evit {
namespace {

// Sums over the points near another one, relative to it: kept by lane, so that the order of additions is the
// same on every machine.
struct NearSums {
  alignas(64) float count[kLanes] = {}, weight[kLanes] = {}, mean[3][kLanes] = {}, square[6][kLanes] = {};
};

// e^(-d2 / (2 sigma^2)) within two sigmas, as the eighth power of a polynomial (error below 1e-5). `rate`: 1
// / (16 sigma^2).
EVIT_ALWAYS_INLINE float Weight(float d2, float rate) {
  const float t = d2 * rate;
  const float root = 1 - t * (1 - t * (0.5F - t * (1.0F / 6 - t * (1.0F / 24))));
  const float squared = root * root, fourth = squared * squared;
  return fourth * fourth;
}

// Points relative to one: x, y, z (m), and how many each stands for. n is a multiple of kLanes.
EVIT_MULTIVERSION void Sum(const float* x, const float* y, const float* z, const float* count, std::size_t n,
                           float rate, NearSums* sums) {
  NearSums s;
  for (std::size_t k = 0; k < n; k += kLanes) {
    for (int l = 0; l < kLanes; ++l) {
      const float dx = x[k + l], dy = y[k + l], dz = z[k + l], c = count[k + l];
      const float w = c * Weight(dx * dx + (dy * dy + dz * dz), rate);
      const float wx = w * dx, wy = w * dy, wz = w * dz;
      s.count[l] += c, s.weight[l] += w;
      s.mean[0][l] += wx, s.mean[1][l] += wy, s.mean[2][l] += wz;
      s.square[0][l] += wx * dx, s.square[1][l] += wx * dy, s.square[2][l] += wx * dz;
      s.square[3][l] += wy * dy, s.square[4][l] += wy * dz, s.square[5][l] += wz * dz;
    }
  }
  *sums = s;
}

// Over the lanes, each in their order; all at once, as each waits for the addition before.
struct NearTotals {
  explicit NearTotals(const NearSums& sums) {
    for (int l = 0; l < kLanes; ++l) {
      count += sums.count[l], weight += sums.weight[l];
      for (int k = 0; k < 3; ++k) mean[k] += sums.mean[k][l];
      for (int k = 0; k < 6; ++k) square[k] += sums.square[k][l];
    }
  }
  double count = 0, weight = 0, mean[3] = {}, square[6] = {};
};

/// Points by cells of a grid as wide as the radius, in the order of their cells.
class Neighbours {
 public:
  Neighbours(const std::vector<Eigen::Vector3f>& points, double radius)
      : points_(points), inverse_(1 / radius), radius2_(static_cast<float>(radius * radius)) {
    cells_.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) cells_.emplace_back(Key(Cell(points[i])), i);
    std::sort(cells_.begin(), cells_.end());
    sorted_.reserve(points.size());
    for (const auto& [cell, i] : cells_) sorted_.push_back(points[i]);
  }

  /// Calls visit(index) for each point, cell by cell, and gathers what is around a cell once for all its
  /// points. Once.
  template <typename Visit>
  void ForEachPoint(Visit visit) {
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      if (k == 0 || cells_[k].first != cells_[k - 1].first) Gather(Cell(points_[cells_[k].second]));
      visit(cells_[k].second);
    }
  }

  /// Sums over all within the radius of point `self`, of the cell that ForEachPoint() is at, itself left out,
  /// with Gaussian weights of half the radius; over a crowd's even part.
  NearSums Near(std::size_t self) {
    FindNear(around_, points_[self].data(), radius2_, static_cast<std::int32_t>(self), &near_);
    NearSums sums;
    Sum(near_.dx.data(), near_.dy.data(), near_.dz.data(), near_.count.data(), near_.room, 0.25F / radius2_,
        &sums);
    return sums;
  }

 private:
  static constexpr std::size_t kCrowd = 96;  // points in three cells

  void Gather(const std::array<std::int64_t, 3>& at) {
    around_.Clear();
    auto row = rows_.begin();
    for (std::int64_t x = -1; x <= 1; ++x) {
      for (std::int64_t y = -1; y <= 1; ++y, ++row) {
        // Three cells along z follow each other. Cells come in order, so that each of the nine rows moves on
        // through the points, and none has to be searched for.
        const std::uint64_t first = Key({at[0] + x, at[1] + y, at[2] - 1}),
                            last = Key({at[0] + x, at[1] + y, at[2] + 1});
        while (row->begin < cells_.size() && cells_[row->begin].first < first) ++row->begin;
        row->end = std::max(row->begin, row->end);
        while (row->end < cells_.size() && cells_[row->end].first <= last) ++row->end;
        // A crowd is asked in part: the time must not grow with its square.
        const std::size_t step = 1 + (row->end - row->begin) / kCrowd;
        for (std::size_t k = row->begin; k < row->end; k += step) {
          const Eigen::Vector3f& q = sorted_[k];
          around_.Add(q.x(), q.y(), q.z(), static_cast<float>(step),
                      static_cast<std::int32_t>(cells_[k].second));
        }
      }
    }
    while (around_.size() % kLanes != 0)
      around_.Add(around_.x[0], around_.y[0], around_.z[0], 0, around_.index[0]);  // stands for none
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
  std::vector<Eigen::Vector3f> sorted_;  // points in the order of cells_: what is gathered lies together
  struct Row {
    std::size_t begin = 0, end = 0;  // of the points in three cells
  };
  std::array<Row, 9> rows_;  // around the cell that ForEachPoint() is at
  Surroundings around_;      // the points in them
  NearPoints near_;
};

// Where point `self` moves; `n`: points within the radius, itself included.
Eigen::Vector3f OntoLine(Neighbours* neighbours, const Eigen::Vector3f& p, std::size_t self,
                         std::int64_t* n) {
  const NearTotals near(neighbours->Near(self));
  *n = 1 + std::llround(near.count);
  const double weight = 1 + near.weight;  // p itself lies at its own origin
  const Eigen::Vector3d mean = Eigen::Vector3d(near.mean) / weight;
  Eigen::Matrix3d square;
  const double* const s = near.square;
  square << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  const Eigen::Matrix3d covariance = square / weight - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3d along = solver.eigenvectors().col(2);
  return p + (mean - along * along.dot(mean)).cast<float>();
}

}  // namespace

DenoiseSettings DenoiseSettingsFor(const PointMap& map) {
  DenoiseSettings settings;
  if (!map.attributes.empty()) settings.radius = 0;
  return settings;
}

DenoiseSummary Denoise(const DenoiseSettings& settings, PointMap* map) {
  DenoiseSummary summary;
  if (map->points.empty() || settings.radius <= 0) return summary;
  Neighbours neighbours(map->points, settings.radius);
  std::vector<Eigen::Vector3f> moved(map->points.size());
  std::vector<std::int64_t> n(map->points.size());
  neighbours.ForEachPoint([&](std::size_t i) { moved[i] = OntoLine(&neighbours, map->points[i], i, &n[i]); });
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
