#include "common/map/denoise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "common/map/cell_order.h"
#include "common/simd/lanes.h"

namespace evit {
namespace {

// e^(-d2 / (2 sigma^2)) within two sigmas, as the eighth power of a polynomial (error below 1e-5). `rate`: 1
// / (16 sigma^2).
EVIT_ALWAYS_INLINE float Weight(float d2, float rate) {
  const float t = d2 * rate;
  const float root = 1 - t * (1 - t * (0.5F - t * (1.0F / 6 - t * (1.0F / 24))));
  const float squared = root * root, fourth = squared * squared;
  return fourth * fourth;
}

// Points in the order of their cells; of some of them every `step`th, which stands for so many.
using Points = std::vector<Eigen::Vector3f>;
struct Row {
  std::size_t begin = 0, end = 0, step = 1;
};
using Rows = std::array<Row, 9>;

// A block of points of one cell, each in its lane: so each has its own sums, in the order of the points
// around, the same on every machine.
struct PointLanes {
  alignas(64) float x[kLanes], y[kLanes], z[kLanes];  // m
  alignas(64) std::int32_t place[kLanes];             // in the order of cells
};

// Over those of the points around that lie within the radius of a point, itself left out; places relative to
// it.
struct NearSums {
  alignas(64) float count[kLanes] = {}, weight[kLanes] = {};
  alignas(64) float x[kLanes] = {}, y[kLanes] = {}, z[kLanes] = {};
  alignas(64) float xx[kLanes] = {}, xy[kLanes] = {}, xz[kLanes] = {}, yy[kLanes] = {}, yz[kLanes] = {},
                    zz[kLanes] = {};
};

EVIT_MULTIVERSION_WIDE void SumNear(const Points& points, const Rows& rows, const PointLanes& p,
                                    float radius2, NearSums* sums) {
  NearSums s;
  const float rate = 0.25F / radius2;  // weights of half the radius
  for (const Row& row : rows) {
    const auto stands_for = static_cast<float>(row.step);
    for (std::size_t k = row.begin; k < row.end; k += row.step) {
      const float qx = points[k].x(), qy = points[k].y(), qz = points[k].z();
      const auto place = static_cast<std::int32_t>(k);
      for (int l = 0; l < kLanes; ++l) {
        const float dx = qx - p.x[l], dy = qy - p.y[l], dz = qz - p.z[l];
        const float d2 = dx * dx + (dy * dy + dz * dz);
        const float c = (d2 <= radius2 ? stands_for : 0) * (place != p.place[l] ? 1.0F : 0.0F);
        const float w = c > 0 ? c * Weight(d2, rate) : 0;  // strays are too far for a weight
        const float wx = w * dx, wy = w * dy, wz = w * dz;
        s.count[l] += c, s.weight[l] += w;
        s.x[l] += wx, s.y[l] += wy, s.z[l] += wz;
        s.xx[l] += wx * dx, s.xy[l] += wx * dy, s.xz[l] += wx * dz;
        s.yy[l] += wy * dy, s.yz[l] += wy * dz, s.zz[l] += wz * dz;
      }
    }
  }
  *sums = s;
}

// Moves each point onto the line through its neighbours: their mean, and the direction in which they spread
// most. That is the column of a high power of their covariance: the other directions' shares vanish.
EVIT_MULTIVERSION void MoveOntoLines(const NearSums& s, PointLanes* p) {
  constexpr int kSquarings = 6;
  for (int l = 0; l < kLanes; ++l) {
    const float inverse = 1 / (1 + s.weight[l]);  // the point itself lies at its own origin
    const float mx = inverse * s.x[l], my = inverse * s.y[l], mz = inverse * s.z[l];
    float xx = inverse * s.xx[l] - mx * mx, xy = inverse * s.xy[l] - mx * my;
    float xz = inverse * s.xz[l] - mx * mz, yy = inverse * s.yy[l] - my * my;
    float yz = inverse * s.yz[l] - my * mz, zz = inverse * s.zz[l] - mz * mz;
    for (int k = 0; k < kSquarings; ++k) {
      const float trace = xx + (yy + zz), scale = 1 / (trace > 1e-30F ? trace : 1e-30F);
      const float a = scale * xx, b = scale * xy, c = scale * xz, d = scale * yy, e = scale * yz,
                  f = scale * zz;
      xx = a * a + (b * b + c * c), yy = b * b + (d * d + e * e), zz = c * c + (e * e + f * f);
      xy = a * b + (b * d + c * e), xz = a * c + (b * e + c * f), yz = b * c + (d * e + e * f);
    }
    // The column of the largest diagonal element is the longest.
    const bool second = yy > xx;
    float ux = second ? xy : xx, uy = second ? yy : xy, uz = second ? yz : xz;
    const bool third = zz > (second ? yy : xx);
    ux = third ? xz : ux, uy = third ? yz : uy, uz = third ? zz : uz;
    const float square = ux * ux + (uy * uy + uz * uz);
    const float along = (ux * mx + (uy * my + uz * mz)) / (square > 1e-30F ? square : 1e-30F);
    p->x[l] += mx - along * ux, p->y[l] += my - along * uy, p->z[l] += mz - along * uz;
  }
}

/// The points of a map, cell by cell of a grid as wide as the radius.
class Neighbours {
 public:
  Neighbours(const Points& points, double radius)
      : order_(points, radius), radius2_(static_cast<float>(radius * radius)) {
    sorted_.reserve(points.size());
    for (std::size_t k = 0; k < order_.size(); ++k) sorted_.push_back(points[order_[k].index]);
  }

  /// Where each point moves, and how many points are within the radius, itself included.
  void MoveAll(Points* moved, std::vector<std::int64_t>* n) {
    for (std::size_t begin = 0, end = 0; begin < order_.size(); begin = end) {
      end = order_.EndOfCell(begin);
      MoveRowsTo(order_.CellOf(sorted_[begin]));
      for (std::size_t k = begin; k < end; k += kLanes) Move(k, std::min(end, k + kLanes), moved, n);
    }
  }

 private:
  static constexpr std::size_t kCrowd = 96;  // points in three cells

  void MoveRowsTo(const CellOrder::Cell& at) {
    auto row = rows_.begin();
    for (std::int64_t x = -1; x <= 1; ++x) {
      for (std::int64_t y = -1; y <= 1; ++y, ++row) {
        // Three cells along z follow each other. Cells come in order, so that each of the nine rows moves on
        // through the points, and none has to be searched for.
        const std::uint64_t first = order_.KeyOf({at[0] + x, at[1] + y, at[2] - 1}),
                            last = order_.KeyOf({at[0] + x, at[1] + y, at[2] + 1});
        while (row->begin < order_.size() && order_[row->begin].key < first) ++row->begin;
        row->end = std::max(row->begin, row->end);
        while (row->end < order_.size() && order_[row->end].key <= last) ++row->end;
        // A crowd is asked in part: the time must not grow with its square.
        row->step = 1 + (row->end - row->begin) / kCrowd;
      }
    }
  }

  // Points [begin, end), at most kLanes of the cell that the rows are around.
  void Move(std::size_t begin, std::size_t end, Points* moved, std::vector<std::int64_t>* n) const {
    PointLanes p;
    for (std::size_t l = 0; l < kLanes; ++l) {
      const std::size_t k = std::min(begin + l, end - 1);
      p.x[l] = sorted_[k].x(), p.y[l] = sorted_[k].y(), p.z[l] = sorted_[k].z();
      p.place[l] = static_cast<std::int32_t>(k);
    }
    NearSums sums;
    SumNear(sorted_, rows_, p, radius2_, &sums);
    MoveOntoLines(sums, &p);
    for (std::size_t l = 0; l < end - begin; ++l) {
      const auto index = static_cast<std::size_t>(order_[begin + l].index);
      (*moved)[index] = {p.x[l], p.y[l], p.z[l]};
      (*n)[index] = 1 + std::llround(sums.count[l]);
    }
  }

  CellOrder order_;
  Points sorted_;
  float radius2_;
  Rows rows_;  // three cells each, around the cell that MoveAll() is at
};

}  // namespace

DenoiseSettings DenoiseSettingsFor(const PointMap& map, double spacing) {
  // A compromise over five real maps and eleven simulated ones, with points 2 to 10 mm apart
  // (docs/results/trials.md): real maps would have less, simulated ones, whose points are noisier, more.
  // Bundles are some millimetres wide however densely they are sampled; wider radii have not been tried.
  constexpr double kTimesSpacing = 2.5, kLeast = 0.01, kMost = 0.025;  // -, m, m
  DenoiseSettings settings;
  if (map.attributes.empty()) settings.radius = std::clamp(kTimesSpacing * spacing, kLeast, kMost);
  return settings;
}

DenoiseSummary Denoise(const DenoiseSettings& settings, PointMap* map) {
  DenoiseSummary summary;
  if (map->points.empty() || settings.radius <= 0) return summary;
  Neighbours neighbours(map->points, settings.radius);
  std::vector<Eigen::Vector3f> moved(map->points.size());
  std::vector<std::int64_t> n(map->points.size());
  neighbours.MoveAll(&moved, &n);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (n[i] < settings.min_neighbours) continue;
    map->points[i] = moved[i];
    ++summary.n_moved;
  }
  const bool dense = 2 * summary.n_moved >= n.size();
  if (dense) KeepIf(map, [&n](std::size_t i) { return n[i] > 1; });
  summary.n_dropped = n.size() - map->points.size();
  return summary;
}

}  // namespace evit
