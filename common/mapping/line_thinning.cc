#include "common/mapping/line_thinning.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "common/parallel/parallel_for.h"

namespace evit {
namespace {

using CellKey = std::uint64_t;

constexpr double kSameWay = 0.85;  // cosine of the angle between the directions of one line's points

// Three numbers of 20 bits and `extra` below 16.
CellKey Key(const Eigen::Vector3i& cell, unsigned extra) {
  CellKey key = extra;
  for (int axis = 0; axis < 3; ++axis)
    key = key << 20U | (static_cast<CellKey>(static_cast<std::uint32_t>(cell[axis])) & 0xFFFFFU);
  return key;
}

Eigen::Vector3i CellOf(const Eigen::Vector3d& p, double size) {
  return (p / size).array().floor().cast<int>();
}

// The axis that a direction is nearest to, and which way: 0..5.
unsigned MainDirection(const Eigen::Vector3d& direction) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return static_cast<unsigned>(2 * axis + (direction[axis] < 0 ? 1 : 0));
}

// Weighted mean of points that lie on one line.
struct Mean {
  double weight = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::Zero();
  double views = 0, seen = 0, contrast = 0;

  void Add(const MappedPoint& p, double w) {
    weight += w;
    position += w * p.position;
    direction += w * p.direction;
    views = std::max(views, p.views);
    seen += w * p.seen;
    contrast += w * p.contrast;
  }
};

// Points by cells as large as the farthest neighbour that is looked for.
class PointCells {
 public:
  PointCells(const std::vector<MappedPoint>& points, double reach) : points_(points), reach_(reach) {
    for (std::size_t k = 0; k < points.size(); ++k)
      cells_[Key(CellOf(points[k].position, reach), 0)].push_back(static_cast<std::uint32_t>(k));
  }

  // Calls visit(other, along, across) for all points of about the direction of `own`, itself too, no farther
  // from it along its line than the reach and across than `aside`.
  template <typename Visit>
  void VisitLine(const MappedPoint& own, double aside, const Visit& visit) const {
    const Eigen::Vector3i middle = CellOf(own.position, reach_);
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          const auto it = cells_.find(Key(middle + Eigen::Vector3i(dx, dy, dz), 0));
          if (it == cells_.end()) continue;
          for (const std::uint32_t j : it->second) {
            const MappedPoint& other = points_[j];
            if (other.direction.dot(own.direction) < kSameWay) continue;
            const Eigen::Vector3d off = other.position - own.position;
            const double along = off.dot(own.direction);
            const Eigen::Vector3d across = off - along * own.direction;
            if (std::abs(along) <= reach_ && across.norm() <= aside) visit(other, along, across);
          }
        }
      }
    }
  }

 private:
  const std::vector<MappedPoint>& points_;
  double reach_;
  std::unordered_map<CellKey, std::vector<std::uint32_t>> cells_;
};

// Calls work(k) for all points, by several threads.
template <typename Work>
void ForEachPoint(std::size_t n, int threads, const Work& work) {
  constexpr std::size_t kBlock = 512;
  ParallelFor(static_cast<int>((n + kBlock - 1) / kBlock), threads, [&](int block) {
    const std::size_t begin = static_cast<std::size_t>(block) * kBlock;
    for (std::size_t k = begin; k < std::min(n, begin + kBlock); ++k) work(k);
  });
}

double WeightOf(const MappedPoint& p) { return 1 / (p.sigma * p.sigma + 1e-8); }

// Onto the line through the neighbours: only across it, so that lines keep their ends.
std::vector<MappedPoint> MoveOntoLines(const std::vector<MappedPoint>& points,
                                       const LineThinningOptions& options, int threads) {
  const PointCells cells(points, options.reach_m);
  std::vector<MappedPoint> moved = points;
  ForEachPoint(points.size(), threads, [&](std::size_t k) {
    const MappedPoint& own = points[k];
    // No farther aside than what the errors allow: beside a line there may be another.
    const double aside = std::clamp(2.5 * own.sigma, options.voxel_m, options.reach_m);
    Eigen::Vector3d off_sum = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::Zero();
    double weight = 0;
    cells.VisitLine(own, aside, [&](const MappedPoint& other, double along, const Eigen::Vector3d& across) {
      const double near = std::exp(-2 * along * along / (options.reach_m * options.reach_m));
      const double w = near * WeightOf(other);
      weight += w;
      off_sum += w * across;
      direction += w * other.direction;
    });
    moved[k].position = own.position + off_sum / weight;
    moved[k].direction = direction.normalized();
  });
  return moved;
}

// Of neighbours that have become one, the best.
std::vector<MappedPoint> BestOfVoxels(const std::vector<MappedPoint>& points, double voxel_m) {
  std::unordered_map<CellKey, std::size_t> places;
  std::vector<MappedPoint> best;
  for (const MappedPoint& p : points) {
    const CellKey key = Key(CellOf(p.position, voxel_m), MainDirection(p.direction));
    const auto [it, fresh] = places.emplace(key, best.size());
    if (fresh) {
      best.push_back(p);
    } else if (p.sigma < best[it->second].sigma) {
      best[it->second] = p;
    }
  }
  return best;
}

}  // namespace

LineThinningOptions ForDepth(LineThinningOptions options, double depth_m) {
  if (!options.finer_near) return options;
  constexpr double kFullSize = 1.3, kSmallest = 0.1;  // m away; share
  const double scale = std::clamp(depth_m / kFullSize, kSmallest, 1.0);
  options.voxel_m *= scale, options.reach_m *= scale;
  return options;
}

std::vector<MappedPoint> ThinToVoxels(const std::vector<MappedPoint>& points, double voxel_m) {
  std::unordered_map<CellKey, std::size_t> places;
  std::vector<Mean> means;
  std::vector<double> best;  // sigma
  for (const MappedPoint& p : points) {
    const CellKey key = Key(CellOf(p.position, voxel_m), MainDirection(p.direction));
    const auto [it, fresh] = places.emplace(key, means.size());
    if (fresh) means.emplace_back(), best.push_back(p.sigma);
    means[it->second].Add(p, WeightOf(p));
    best[it->second] = std::min(best[it->second], p.sigma);
  }
  std::vector<MappedPoint> thin;
  for (std::size_t k = 0; k < means.size(); ++k) {
    const Mean& m = means[k];
    MappedPoint p;
    p.position = m.position / m.weight;
    p.direction = m.direction.normalized();
    // Views that share neighbours err together: a voxel is no better than a third of its best point's
    // error.
    p.sigma = std::max(1 / std::sqrt(m.weight), best[k] / 3);
    p.views = m.views;
    p.seen = m.seen / m.weight;
    p.contrast = m.contrast / m.weight;
    thin.push_back(p);
  }
  return thin;
}

std::vector<MappedPoint> ThinToLines(const std::vector<MappedPoint>& points,
                                     const LineThinningOptions& options, int threads) {
  // First to voxels: what is left of it is few enough to look at neighbours.
  const std::vector<MappedPoint> thin = ThinToVoxels(points, options.voxel_m);
  return BestOfVoxels(MoveOntoLines(thin, options, threads), options.voxel_m);
}

std::vector<MappedPoint> DropLonePoints(const std::vector<MappedPoint>& points,
                                        const LineThinningOptions& options, int threads) {
  const double reach = 2 * options.reach_m;
  const auto least = static_cast<int>(std::lround(options.min_share * 2 * reach / options.voxel_m));
  const PointCells cells(points, reach);
  std::vector<char> kept(points.size(), 0);
  ForEachPoint(points.size(), threads, [&](std::size_t k) {
    int n = 0;  // one voxel has one point
    cells.VisitLine(points[k], std::max(options.voxel_m, 0.6 * options.reach_m),
                    [&](const MappedPoint&, double, const Eigen::Vector3d&) { ++n; });
    kept[k] = n >= least ? 1 : 0;
  });
  std::vector<MappedPoint> lines;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (kept[k] != 0) lines.push_back(points[k]);
  }
  return lines;
}

}  // namespace evit
