#include "common/tracking/active_points.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "common/map/spread_subset.h"

namespace evit {
namespace {

constexpr double kBorder =
    4;  // pixels: points closer to the edge would leave the image while the solver moves
constexpr double kAnyDepth = 1e30;

}  // namespace

ActivePoints::ActivePoints(const Camera& camera, const SE3& T_camera_body, std::uint64_t seed)
    : camera_(camera), T_camera_body_(T_camera_body), seed_(seed) {}

void ActivePoints::Clear() {
  ids_.clear();
  points_.Resize(0);
}

void ActivePoints::Merge(const std::vector<std::int32_t>& ids, const std::vector<Eigen::Vector3f>& points) {
  std::vector<std::size_t> order(ids.size());
  std::iota(order.begin(), order.end(), 0);
  if (!std::is_sorted(ids.begin(), ids.end())) {
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
  }
  std::vector<std::int32_t> merged_ids;
  PointArrays merged;
  merged_ids.reserve(ids_.size() + ids.size());
  merged.Resize(ids_.size() + ids.size());
  const auto take = [&](std::int32_t id, const Eigen::Vector3f& p) {
    merged.Set(merged_ids.size(), p);
    merged_ids.push_back(id);
  };
  std::size_t a = 0;
  for (const std::size_t b : order) {
    for (; a < ids_.size() && ids_[a] < ids[b]; ++a) take(ids_[a], points_.At(a));
    if (a < ids_.size() && ids_[a] == ids[b]) ++a;  // the newer answer counts
    if (!merged_ids.empty() && merged_ids.back() == ids[b]) continue;
    take(ids[b], points[b]);
  }
  for (; a < ids_.size(); ++a) take(ids_[a], points_.At(a));
  merged.Resize(merged_ids.size());
  std::swap(ids_, merged_ids);
  std::swap(points_, merged);
}

std::vector<ProjectedPoint> ActivePoints::SeenOf(const PointArrays& points,
                                                 const std::vector<std::int32_t>& places,
                                                 const SE3& T_map_body, double margin_px) const {
  const ViewProjector projector(camera_, T_camera_body_ * T_map_body.Inverse(), margin_px, 0, kAnyDepth);
  std::vector<ProjectedPoint> seen(places.size() + 1);
  seen.resize(projector.Project(points, places.data(), 0, places.size(), seen.data()));
  return seen;
}

std::vector<ProjectedPoint> ActivePoints::Seen(const SE3& T_map_body, double margin_px) const {
  std::vector<std::int32_t> places(ids_.size());
  std::iota(places.begin(), places.end(), 0);
  return SeenOf(points_, places, T_map_body, margin_px);
}

void ActivePoints::Retain(const std::vector<SE3>& T_map_body, double margin_px) {
  // The poses see much the same: each looks at those only that no other has seen.
  std::vector<std::uint8_t> keep(ids_.size(), 0);
  std::vector<std::int32_t> places(ids_.size());
  std::iota(places.begin(), places.end(), 0);
  PointArrays rest = points_;
  for (const SE3& pose : T_map_body) {
    for (const ProjectedPoint& p : SeenOf(rest, places, pose, margin_px)) keep[p.id] = 1;
    std::size_t n = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (keep[places[k]] != 0) continue;
      rest.Set(n, rest.At(k));
      places[n++] = places[k];
    }
    places.resize(n);
    rest.Resize(n);
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < ids_.size(); ++k) {
    if (keep[k] == 0) continue;
    ids_[kept] = ids_[k];
    points_.Set(kept++, points_.At(k));
  }
  ids_.resize(kept);
  points_.Resize(kept);
}

double ActivePoints::Shift(const SE3& from, const SE3& to) const {
  constexpr std::size_t kSome = 200, kFewest = 20;  // points
  const SE3 T_from = T_camera_body_ * from.Inverse(), T_to = T_camera_body_ * to.Inverse();
  std::vector<double> shifts;
  for (std::size_t k = 0; k < ids_.size(); k += 1 + ids_.size() / kSome) {
    const Eigen::Vector3d p = points_.At(k).cast<double>();
    Eigen::Vector2d before, after;
    if (!camera_.Project(T_to * p, &after) || !camera_.Contains(after)) continue;
    shifts.push_back(camera_.Project(T_from * p, &before) ? (after - before).norm()
                                                          : std::numeric_limits<double>::infinity());
  }
  if (shifts.size() < kFewest) return std::numeric_limits<double>::infinity();
  const auto most = shifts.begin() + static_cast<std::ptrdiff_t>(shifts.size() * 9 / 10);
  std::nth_element(shifts.begin(), most, shifts.end());
  return *most;
}

std::vector<Eigen::Vector3f> ActivePoints::Sample(const SE3& T_map_body, int count,
                                                  std::uint64_t salt) const {
  std::vector<ProjectedPoint> seen = Seen(T_map_body, -kBorder);
  std::vector<std::int32_t> places;
  places.reserve(seen.size());
  for (ProjectedPoint& p : seen) {  // the draw goes by the map's ids, whatever the order here
    places.push_back(p.id);
    p.id = ids_[p.id];
  }
  std::vector<Eigen::Vector3f> sample;
  for (const std::int32_t k : SpreadSubset(seen, {camera_.width, camera_.height, -kBorder},
                                           static_cast<std::size_t>(count), seed_ ^ Mix(salt))) {
    sample.push_back(points_.At(places[k]));
  }
  return sample;
}

}  // namespace evit
