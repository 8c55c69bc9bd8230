#include "common/map/map_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/map/cell_order.h"
#include "common/map/occlusion.h"
#include "common/map/spread_subset.h"
#include "common/map/view_projector.h"

namespace evit {
namespace {

constexpr double kCell = 0.25;  // m: a cell's bounding sphere is small against the view, yet cells are few

struct Cell {
  Eigen::Vector3f center;
  float radius;
  std::int32_t begin, end;  // into the reordered points
};

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

// Ascending; none negative. By digits of 11 bits: thousands at a time, of which a comparison says little.
void SortIds(std::vector<std::int32_t>* ids) {
  constexpr int kBits = 11;
  constexpr std::int32_t kMask = (1 << kBits) - 1;
  const std::int32_t largest = ids->empty() ? 0 : *std::max_element(ids->begin(), ids->end());
  std::vector<std::int32_t> sorted(ids->size());
  for (int shift = 0; shift < 31 && (largest >> shift) > 0; shift += kBits) {
    std::array<std::size_t, kMask + 2> begin{};
    for (const std::int32_t id : *ids) ++begin[((id >> shift) & kMask) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (const std::int32_t id : *ids) sorted[begin[(id >> shift) & kMask]++] = id;
    std::swap(*ids, sorted);
  }
}

}  // namespace

struct MapIndex::Impl {
  PointMap map;
  std::vector<Cell> cells;
  PointArrays ordered;            // the map's points, cell by cell
  std::vector<std::int32_t> ids;  // their indices in the map
};

MapIndex::MapIndex(PointMap map) : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  m.map = std::move(map);
  const auto& points = m.map.points;
  const CellOrder order(points, kCell);
  m.ids.reserve(points.size());
  m.ordered.Resize(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    m.ids.push_back(order[k].index);
    m.ordered.Set(k, points[m.ids[k]]);
  }
  for (std::size_t begin = 0; begin < m.ids.size();) {
    const std::size_t end = order.EndOfCell(begin);
    Eigen::AlignedBox3f box;
    for (std::size_t k = begin; k < end; ++k) box.extend(m.ordered.At(k));
    // The margin covers what single precision loses when the cell is turned into the camera's frame.
    const float slack = 1e-4F + 1e-6F * box.center().norm();
    m.cells.push_back({box.center(), 0.5F * box.diagonal().norm() + slack, static_cast<std::int32_t>(begin),
                       static_cast<std::int32_t>(end)});
    begin = end;
  }
}

MapIndex::~MapIndex() = default;
MapIndex::MapIndex(MapIndex&&) noexcept = default;
MapIndex& MapIndex::operator=(MapIndex&&) noexcept = default;

const PointMap& MapIndex::map() const { return impl_->map; }

std::size_t MapIndex::MemoryBytes() const {
  const std::size_t n = impl_->ids.size();
  return n * (sizeof(Eigen::Vector3f) + 3 * sizeof(float) + sizeof(std::int32_t)) +
         impl_->cells.size() * sizeof(Cell);
}

std::vector<std::pair<std::size_t, std::size_t>> MapIndex::CellsInView(const VisibilityQuery& query,
                                                                       const SE3& T_camera_map) const {
  const Eigen::Matrix3f R = T_camera_map.R().cast<float>();
  const Eigen::Vector3f t = T_camera_map.p.cast<float>();
  const auto near = static_cast<float>(query.min_depth);
  const auto far = static_cast<float>(std::min(query.max_depth, 1e30));
  std::array<Eigen::Vector3f, 4> normals;
  const auto exact = FrustumNormals(query.camera, query.margin_px);
  std::transform(exact.begin(), exact.end(), normals.begin(),
                 [](const auto& n) { return n.template cast<float>(); });
  std::vector<std::pair<std::size_t, std::size_t>> ranges;
  for (const Cell& cell : impl_->cells) {
    const Eigen::Vector3f c = R * cell.center + t;
    const float r = cell.radius;
    if (c.z() + r < near || c.z() - r > far) continue;
    if (std::any_of(normals.begin(), normals.end(), [&](const auto& n) { return n.dot(c) < -r; })) continue;
    if (!ranges.empty() && ranges.back().second == static_cast<std::size_t>(cell.begin)) {
      ranges.back().second = cell.end;  // neighbours in memory: one longer loop
    } else {
      ranges.emplace_back(cell.begin, cell.end);
    }
  }
  return ranges;
}

VisibilityAnswer MapIndex::Query(const VisibilityQuery& query) const {
  const SE3 T_camera_map = query.T_map_camera.Inverse();
  const ViewProjector projector(query.camera, T_camera_map, query.margin_px, query.min_depth,
                                query.max_depth);
  const auto ranges = CellsInView(query, T_camera_map);
  std::size_t room = 1, n = 0;
  for (const auto& [begin, end] : ranges) room += end - begin;
  std::vector<ProjectedPoint> seen(room);
  for (const auto& [begin, end] : ranges) {
    n += projector.Project(impl_->ordered, impl_->ids.data(), begin, end, seen.data() + n);
  }
  seen.resize(n);
  if (query.occlusion) RemoveOccluded(query.camera, query.margin_px, &seen);

  VisibilityAnswer answer;
  answer.n_visible = static_cast<std::int32_t>(seen.size());
  if (query.max_points > 0 && seen.size() > static_cast<std::size_t>(query.max_points)) {
    const ScreenArea area{query.camera.width, query.camera.height, query.margin_px};
    answer.ids = SpreadSubset(seen, area, static_cast<std::size_t>(query.max_points), query.seed);
    for (std::int32_t& place : answer.ids) place = seen[place].id;
  } else {
    answer.ids.reserve(seen.size());
    for (const ProjectedPoint& p : seen) answer.ids.push_back(p.id);
  }
  SortIds(&answer.ids);
  return answer;
}

}  // namespace evit
