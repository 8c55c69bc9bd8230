#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "common/map/occlusion.h"
#include "common/map/visibility.h"

namespace evit {
namespace {

constexpr float kCell = 0.25F;     // m: a cell's bounding sphere is small against the view, yet cells are few
constexpr float kFarthest = 1e9F;  // cells: strays beyond share the last one, whose index an int still holds
constexpr int kTile = 32;          // pixels: the subset is drawn evenly from tiles of this size

struct Cell {
  Eigen::Vector3f center;
  float radius;
  std::int32_t begin, end;  // into the reordered points
};

// SplitMix64: a well-mixed number per (seed, id), without state.
std::uint64_t Mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

// Half-spaces of the camera frame that hold everything the widened image can see. The border of a distorted
// image is not straight, so each plane is pushed outwards to the farthest of the border's rays.
std::array<Eigen::Vector3d, 4> FrustumNormals(const Camera& camera, double margin) {
  double left = 0, right = 0, top = 0, bottom = 0;
  const double x0 = -margin, x1 = camera.width - 1 + margin, y0 = -margin, y1 = camera.height - 1 + margin;
  constexpr int kSteps = 16;
  constexpr double kBulge = 1.02;
  bool complete = true;
  for (int k = 0; k <= kSteps; ++k) {
    const double x = x0 + (x1 - x0) * k / kSteps, y = y0 + (y1 - y0) * k / kSteps;
    for (const Eigen::Vector2d& border :
         {Eigen::Vector2d(x, y0), Eigen::Vector2d(x, y1), Eigen::Vector2d(x0, y), Eigen::Vector2d(x1, y)}) {
      Eigen::Vector3d ray;
      Eigen::Vector2d back;
      // A lens model has rays beyond its monotonic radius that come back to the same pixel: none of those.
      if (!camera.Unproject(border, &ray) || !camera.Project(ray, &back)) {
        complete = false;  // the margin reaches beyond what the lens model can invert: no culling by planes
        continue;
      }
      left = std::min(left, ray.x()), right = std::max(right, ray.x());
      top = std::min(top, ray.y()), bottom = std::max(bottom, ray.y());
    }
  }
  if (!complete)
    return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
            Eigen::Vector3d::Zero()};
  // The border may bulge a little between the samples.
  left *= kBulge, right *= kBulge, top *= kBulge, bottom *= kBulge;
  return {Eigen::Vector3d(1, 0, -left).normalized(), Eigen::Vector3d(-1, 0, right).normalized(),
          Eigen::Vector3d(0, 1, -top).normalized(), Eigen::Vector3d(0, -1, bottom).normalized()};
}

// A seeded random subset of query.max_points, spread over the image: every tile may give the same number of
// points, and those it gives are drawn at random, so that a densely mapped spot does not eat the budget.
std::vector<std::int32_t> SpreadSubset(const std::vector<ProjectedPoint>& seen,
                                       const VisibilityQuery& query) {
  using Drawn = std::pair<std::uint64_t, std::int32_t>;  // random number, id
  const int columns = static_cast<int>((query.camera.width + 2 * query.margin_px) / kTile) + 2;
  const int rows = static_cast<int>((query.camera.height + 2 * query.margin_px) / kTile) + 2;
  const auto tile_of = [&](const ProjectedPoint& p) {
    return static_cast<std::size_t>((p.pixel.y() + query.margin_px) / kTile) * columns +
           static_cast<std::size_t>((p.pixel.x() + query.margin_px) / kTile);
  };
  std::vector<std::size_t> begin(static_cast<std::size_t>(columns) * rows + 1, 0);
  for (const ProjectedPoint& p : seen) ++begin[tile_of(p) + 1];
  // The quota is the largest with which the tiles together stay within the budget.
  const auto budget = static_cast<std::size_t>(query.max_points);
  const auto taken = [&](std::size_t quota) {
    std::size_t sum = 0;
    for (std::size_t t = 1; t < begin.size(); ++t) sum += std::min(begin[t], quota);
    return sum;
  };
  std::size_t quota = 0, above = budget + 1;
  while (above - quota > 1) {
    const std::size_t middle = (quota + above) / 2;
    (taken(middle) <= budget ? quota : above) = middle;
  }
  const std::size_t left =
      budget - taken(quota);  // points that still fit: each from a tile with more than the quota
  std::partial_sum(begin.begin(), begin.end(), begin.begin());

  std::vector<Drawn> drawn(seen.size());
  std::vector<std::size_t> end(begin.begin(), begin.end() - 1);
  const std::uint64_t base = Mix(query.seed);
  for (const ProjectedPoint& p : seen) {
    drawn[end[tile_of(p)]++] = {Mix(base ^ static_cast<std::uint64_t>(p.id)), p.id};
  }
  std::vector<std::int32_t> ids;
  std::vector<Drawn> next;  // each rich tile's first point beyond the quota
  ids.reserve(budget);
  for (std::size_t t = 0; t + 1 < begin.size(); ++t) {
    const auto first = drawn.begin() + static_cast<std::ptrdiff_t>(begin[t]);
    const auto last = drawn.begin() + static_cast<std::ptrdiff_t>(begin[t + 1]);
    const auto stop = first + static_cast<std::ptrdiff_t>(std::min(quota, begin[t + 1] - begin[t]));
    if (stop != last) {
      std::nth_element(first, stop, last);
      next.push_back(*stop);
    }
    for (auto k = first; k != stop; ++k) ids.push_back(k->second);
  }
  std::sort(next.begin(), next.end());
  for (std::size_t k = 0; k < left; ++k) ids.push_back(next[k].second);
  return ids;
}

}  // namespace

struct MapIndex::Impl {
  PointMap map;
  std::vector<Cell> cells;
  std::vector<Eigen::Vector3f> ordered;  // the map's points, cell by cell
  std::vector<std::int32_t> ids;         // their indices in the map
};

MapIndex::MapIndex(PointMap map) : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  m.map = std::move(map);
  const auto& points = m.map.points;
  const auto key = [&](std::int32_t k) -> std::array<std::int32_t, 3> {
    const Eigen::Vector3f c = (points[k] / kCell).array().floor().max(-kFarthest).min(kFarthest);
    return {static_cast<std::int32_t>(c.x()), static_cast<std::int32_t>(c.y()),
            static_cast<std::int32_t>(c.z())};
  };
  m.ids.resize(points.size());
  std::iota(m.ids.begin(), m.ids.end(), 0);
  std::vector<std::array<std::int32_t, 3>> keys;
  keys.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) keys.push_back(key(static_cast<std::int32_t>(k)));
  std::stable_sort(m.ids.begin(), m.ids.end(),
                   [&](std::int32_t a, std::int32_t b) { return keys[a] < keys[b]; });
  m.ordered.reserve(points.size());
  for (const std::int32_t id : m.ids) m.ordered.push_back(points[id]);

  for (std::size_t begin = 0; begin < m.ids.size();) {
    std::size_t end = begin;
    Eigen::AlignedBox3f box;
    while (end < m.ids.size() && keys[m.ids[end]] == keys[m.ids[begin]]) box.extend(m.ordered[end++]);
    m.cells.push_back({box.center(), 0.5F * box.diagonal().norm(), static_cast<std::int32_t>(begin),
                       static_cast<std::int32_t>(end)});
    begin = end;
  }
}

MapIndex::~MapIndex() = default;
MapIndex::MapIndex(MapIndex&&) noexcept = default;
MapIndex& MapIndex::operator=(MapIndex&&) noexcept = default;

const PointMap& MapIndex::map() const { return impl_->map; }

VisibilityAnswer MapIndex::Query(const VisibilityQuery& query) const {
  const SE3 T_camera_world = query.T_world_camera.Inverse();
  const Eigen::Matrix3d R = T_camera_world.R();
  const auto normals = FrustumNormals(query.camera, query.margin_px);
  std::vector<ProjectedPoint> seen;
  for (const Cell& cell : impl_->cells) {
    const Eigen::Vector3d c = R * cell.center.cast<double>() + T_camera_world.p;
    const double r = cell.radius + 1e-4;
    if (c.z() + r < query.min_depth || c.z() - r > query.max_depth) continue;
    if (std::any_of(normals.begin(), normals.end(), [&](const auto& n) { return n.dot(c) < -r; })) continue;
    for (std::int32_t k = cell.begin; k < cell.end; ++k) {
      const Eigen::Vector3d p = R * impl_->ordered[k].cast<double>() + T_camera_world.p;
      Eigen::Vector2d pixel;
      if (p.z() < query.min_depth || p.z() > query.max_depth || !query.camera.Project(p, &pixel) ||
          !query.camera.Contains(pixel, -query.margin_px)) {
        continue;
      }
      seen.push_back({impl_->ids[k], pixel.cast<float>(), static_cast<float>(p.z())});
    }
  }
  if (query.occlusion) RemoveOccluded(query.camera, query.margin_px, &seen);

  VisibilityAnswer answer;
  answer.n_visible = static_cast<std::int32_t>(seen.size());
  if (query.max_points > 0 && seen.size() > static_cast<std::size_t>(query.max_points)) {
    answer.ids = SpreadSubset(seen, query);
  } else {
    answer.ids.reserve(seen.size());
    for (const ProjectedPoint& p : seen) answer.ids.push_back(p.id);
  }
  std::sort(answer.ids.begin(), answer.ids.end());
  return answer;
}

}  // namespace evit
