#include "common/overlap/map_views.h"

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

constexpr Utime kAround = 10'000;          // us: half of the time over which a view's motion is taken
constexpr std::size_t kFewestInView = 20;  // points in view

double MedianSpeed(const Camera& camera, const std::vector<Eigen::Vector3f>& points, const SE3& before,
                   const SE3& after) {
  const SE3 a = before.Inverse(), b = after.Inverse();
  std::vector<double> moved;
  for (const Eigen::Vector3f& p : points) {
    Eigen::Vector2d u, v;
    if (camera.Project(a * p.cast<double>(), &u) && camera.Project(b * p.cast<double>(), &v))
      moved.push_back((v - u).norm());
  }
  if (moved.empty()) return 0;
  const auto middle = moved.begin() + static_cast<std::ptrdiff_t>(moved.size() / 2);
  std::nth_element(moved.begin(), middle, moved.end());
  return *middle / ToSeconds(2 * kAround);
}

}  // namespace

std::vector<MapView> PlanViews(const MapIndex& map, const Rig& rig, const Trajectory& body,
                               const MapViewOptions& options) {
  std::vector<MapView> views;
  if (body.empty()) return views;
  for (Utime t = body.front().t + options.longest; t + options.longest <= body.back().t; t += options.step) {
    MapView view;
    SE3 before, after;
    if (!PoseAt(body, t, &view.T_map_body) || !PoseAt(body, t - kAround, &before) ||
        !PoseAt(body, t + kAround, &after)) {
      continue;
    }
    VisibilityQuery query;
    query.T_map_camera = view.T_map_body * rig.T_body_camera;
    query.camera = rig.camera;
    query.margin_px = options.margin_px;
    query.occlusion = options.occlusion;
    query.max_points = options.max_points;
    query.seed = static_cast<std::uint64_t>(t);
    for (const std::int32_t id : map.Query(query).ids)
      view.points.push_back(map.map().points[static_cast<std::size_t>(id)]);
    if (view.points.size() < kFewestInView) continue;
    view.utime = t;
    view.speed_px =
        MedianSpeed(rig.camera, view.points, before * rig.T_body_camera, after * rig.T_body_camera);
    const double lasts = 1e6 * options.slice_px / std::max(view.speed_px, 1e-3);
    const Utime half = std::llround(
        std::clamp(lasts, static_cast<double>(options.shortest), static_cast<double>(options.longest)) / 2);
    view.begin = t - rig.camera_time_offset - half;
    view.end = t - rig.camera_time_offset + half;
    view.fired = PixelSet(rig.camera.width, rig.camera.height);
    views.push_back(std::move(view));
  }
  return views;
}

void ViewFiller::AddEvents(const EventArray& events) {
  if (events.t.empty()) return;
  while (first_ < views_->size() && (*views_)[first_].end <= events.t.front()) ++first_;
  for (std::size_t v = first_; v < views_->size() && (*views_)[v].begin <= events.t.back(); ++v) {
    MapView& view = (*views_)[v];
    const auto begin = std::lower_bound(events.t.begin(), events.t.end(), view.begin),
               end = std::lower_bound(begin, events.t.end(), view.end);
    for (auto k = static_cast<std::size_t>(begin - events.t.begin());
         k < static_cast<std::size_t>(end - events.t.begin()); ++k) {
      if (events.x[k] >= view.fired.width() || events.y[k] >= view.fired.height()) continue;
      view.fired.Add(events.x[k], events.y[k]);
      ++view.n_events;
    }
  }
}

}  // namespace evit
