#include "common/overlap/map_event_overlap.h"

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

std::vector<Eigen::Vector2d> InImage(const Camera& camera, const SE3& T_map_camera, const MapView& view,
                                     double border) {
  const SE3 T_camera_map = T_map_camera.Inverse();
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector3f& p : view.points) {
    Eigen::Vector2d pixel;
    if (camera.Project(T_camera_map * p.cast<double>(), &pixel) && camera.Contains(pixel, border))
      pixels.push_back(pixel);
  }
  return pixels;
}

PixelSet Painted(const Camera& camera, const std::vector<Eigen::Vector2d>& pixels) {
  PixelSet set(camera.width, camera.height);
  for (const Eigen::Vector2d& p : pixels)
    set.Add(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  return set;
}

std::int64_t CountNear(const PixelSet& of, const PixelSet& to, double radius) {
  const NearestPixel nearest(radius);
  std::int64_t n = 0;
  Eigen::Vector2d offset;
  for (int y = 0; y < of.height(); ++y) {
    for (int x = 0; x < of.width(); ++x) n += of.Has(x, y) && nearest.Find(to, {x, y}, &offset) ? 1 : 0;
  }
  return n;
}

}  // namespace

void MapEventOverlap::Add(const MapEventOverlap& other) {
  views += other.views;
  points += other.points;
  points_on_events += other.points_on_events;
  fired += other.fired;
  fired_on_map += other.fired_on_map;
  events += other.events;
  map_pixels += other.map_pixels;
  for (int k = 0; k < kBins; ++k) distances[k] += other.distances[k];
  offset_sum += other.offset_sum;
  points_beside += other.points_beside;
  points_on_events_beside += other.points_on_events_beside;
  fired_on_map_beside += other.fired_on_map_beside;
  moved_px += other.moved_px;
}

MapEventOverlap MeasureOverlap(const Camera& camera, const SE3& T_map_camera, const MapView& view,
                               const OverlapOptions& options) {
  MapEventOverlap overlap;
  const std::vector<Eigen::Vector2d> pixels = InImage(camera, T_map_camera, view, options.border_px);
  const PixelSet painted = Painted(camera, pixels);
  overlap.views = 1;
  overlap.points = static_cast<std::int64_t>(pixels.size());
  overlap.fired = view.fired.size();
  overlap.events = view.n_events;
  overlap.map_pixels = painted.size();
  overlap.moved_px = view.speed_px * ToSeconds(view.end - view.begin);
  const NearestPixel nearest(options.reach_px);
  for (const Eigen::Vector2d& pixel : pixels) {
    Eigen::Vector2d offset;
    if (!nearest.Find(view.fired, pixel, &offset)) continue;
    ++overlap.distances[std::min(MapEventOverlap::kBins - 1, static_cast<int>(2 * offset.norm()))];
    if (offset.norm() > options.radius_px) continue;
    ++overlap.points_on_events;
    overlap.offset_sum += offset;
  }
  if (options.both_ways) overlap.fired_on_map = CountNear(view.fired, painted, options.radius_px);

  const NearestPixel on(options.radius_px);
  for (const Eigen::Vector2d& side :
       {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, 1), Eigen::Vector2d(0, -1)}) {
    std::vector<Eigen::Vector2d> shifted;
    std::int64_t near = 0;
    for (const Eigen::Vector2d& pixel : pixels) {
      const Eigen::Vector2d to = pixel + options.beside_px * side;
      if (!camera.Contains(to, options.border_px)) continue;
      shifted.push_back(to);
      Eigen::Vector2d offset;
      near += on.Find(view.fired, to, &offset) ? 1 : 0;
    }
    overlap.points_beside += 0.25 * static_cast<double>(shifted.size());
    overlap.points_on_events_beside += 0.25 * static_cast<double>(near);
    if (options.both_ways)
      overlap.fired_on_map_beside +=
          0.25 * static_cast<double>(CountNear(view.fired, Painted(camera, shifted), options.radius_px));
  }
  return overlap;
}

MapEventOverlap MeasureOverlap(const Rig& rig, const std::vector<MapView>& views,
                               const OverlapOptions& options) {
  MapEventOverlap sum;
  for (const MapView& view : views)
    sum.Add(MeasureOverlap(rig.camera, view.T_map_body * rig.T_body_camera, view, options));
  return sum;
}

}  // namespace evit
