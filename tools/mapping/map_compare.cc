#include "tools/mapping/map_compare.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <unordered_map>
#include <vector>

#include "common/text/format_text.h"

namespace evit::mapping {
namespace {

// Points by cells; the nearest one is looked for in shells around a place.
class PointGrid {
 public:
  PointGrid(const PointMap& map, double cell_m) : points_(map.points), cell_(static_cast<float>(cell_m)) {
    for (std::size_t k = 0; k < points_.size(); ++k)
      cells_[Key(CellOf(points_[k]))].push_back(static_cast<std::uint32_t>(k));
  }

  float Nearest(const Eigen::Vector3f& p, float reach) const {
    const Eigen::Vector3i middle = CellOf(p);
    float best = reach * reach;
    const int last = static_cast<int>(std::ceil(reach / cell_));
    for (int shell = 0; shell <= last; ++shell) {
      // All in farther shells is at least so far away.
      const float least = static_cast<float>(shell - 1) * cell_;
      if (shell > 0 && least * least > best) break;
      for (int dx = -shell; dx <= shell; ++dx) {
        for (int dy = -shell; dy <= shell; ++dy) {
          const bool inner = std::abs(dx) < shell && std::abs(dy) < shell;
          for (int dz = -shell; dz <= shell; dz += inner && shell > 0 ? 2 * shell : 1)
            Look(middle + Eigen::Vector3i(dx, dy, dz), p, &best);
        }
      }
    }
    return std::sqrt(best);
  }

 private:
  Eigen::Vector3i CellOf(const Eigen::Vector3f& p) const { return (p / cell_).array().floor().cast<int>(); }
  static std::uint64_t Key(const Eigen::Vector3i& cell) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis)
      key = key << 21U | (static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell[axis])) & 0x1FFFFFU);
    return key;
  }
  void Look(const Eigen::Vector3i& cell, const Eigen::Vector3f& p, float* best) const {
    const auto it = cells_.find(Key(cell));
    if (it == cells_.end()) return;
    for (const std::uint32_t k : it->second) *best = std::min(*best, (points_[k] - p).squaredNorm());
  }

  const std::vector<Eigen::Vector3f>& points_;
  float cell_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace

PathDistance::PathDistance(const Trajectory& path) {
  constexpr float kStep = 0.02F;  // m
  for (const StampedPose& pose : path) {
    const Eigen::Vector3f place = pose.pose.p.cast<float>();
    if (places_.empty() || (place - places_.back()).norm() >= kStep) places_.push_back(place);
  }
}

double PathDistance::Of(const Eigen::Vector3f& p) const {
  float best = std::numeric_limits<float>::max();
  for (const Eigen::Vector3f& place : places_) best = std::min(best, (place - p).squaredNorm());
  return std::sqrt(best);
}

PointMap PathDistance::Between(const PointMap& map, double min_m, double max_m) const {
  PointMap part;
  for (const Eigen::Vector3f& p : map.points) {
    const double distance = Of(p);
    if (distance >= min_m && distance <= max_m) part.points.push_back(p);
  }
  return part;
}

MapDistance DistanceBetween(const PointMap& from, const PointMap& to, const PathDistance* path,
                            double limit_m, double reach_m) {
  const PointGrid grid(to, limit_m);
  std::vector<float> distances, shares;
  distances.reserve(from.points.size());
  for (const Eigen::Vector3f& p : from.points) {
    distances.push_back(grid.Nearest(p, static_cast<float>(reach_m)));
    // A point in the path itself has no share.
    const double away = path != nullptr ? path->Of(p) : 0;
    if (away > 0) shares.push_back(distances.back() / static_cast<float>(away));
  }
  std::sort(distances.begin(), distances.end());
  std::sort(shares.begin(), shares.end());
  MapDistance result;
  result.points = distances.size();
  result.median_m = distances[distances.size() / 2];
  result.p95_m = distances[distances.size() * 95 / 100];
  const auto beyond = std::upper_bound(distances.begin(), distances.end(), static_cast<float>(limit_m));
  result.beyond = static_cast<double>(distances.end() - beyond) / static_cast<double>(distances.size());
  if (!shares.empty()) result.median_share = shares[shares.size() / 2];
  return result;
}

std::string CompareText(const std::string& map, const MapDistance& exact, const std::string& reference,
                        const MapDistance& complete, double limit_m, bool json) {
  char text[1000];
  if (json) {
    std::snprintf(text, sizeof text,
                  "{\n  \"points\": %zu,\n  \"median_m\": %.6f,\n  \"p95_m\": %.6f,\n  \"beyond\": %.5f,\n"
                  "  \"median_share\": %.6f,\n  \"limit_m\": %g,\n  \"reference_points\": %zu,\n  "
                  "\"missing\": %.5f\n}\n",
                  exact.points, exact.median_m, exact.p95_m, exact.beyond, exact.median_share, limit_m,
                  complete.points, complete.beyond);
    return text;
  }
  const std::string share =
      exact.median_share > 0
          ? FormatText("  distance  median %.2f %% of the point's distance from the path\n",
                       100 * exact.median_share)
          : "";
  std::snprintf(
      text, sizeof text,
      "%s to %s\n"
      "  points    %zu: median %.1f mm from the nearest of the reference, 95 %% within %.1f mm, %.1f %% "
      "beyond %.0f mm\n"
      "%s"
      "  missing   %.1f %% of the reference's %zu points have none within %.0f mm\n",
      map.c_str(), reference.c_str(), exact.points, 1e3 * exact.median_m, 1e3 * exact.p95_m,
      100 * exact.beyond, 1e3 * limit_m, share.c_str(), 100 * complete.beyond, complete.points,
      1e3 * limit_m);
  return text;
}

}  // namespace evit::mapping
