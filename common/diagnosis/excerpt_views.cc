#include "common/diagnosis/excerpt_views.h"

#include <utility>

namespace evit::diagnosis {
namespace {

EventArray Mirrored(EventArray events, const World& world) {
  for (std::size_t e = 0; e < events.size(); ++e) {
    if (world.mirror_x) events.x[e] = static_cast<std::uint16_t>(world.rig.camera.width - 1 - events.x[e]);
    if (world.mirror_y) events.y[e] = static_cast<std::uint16_t>(world.rig.camera.height - 1 - events.y[e]);
  }
  return events;
}

}  // namespace

std::vector<MapView> ViewsOf(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                             std::size_t stride, MapViewOptions options) {
  std::vector<MapView> all;
  options.step = 10 * options.longest;
  for (std::size_t k = stride / 2; k < excerpts.instants().size(); k += stride) {
    const Utime t = excerpts.instants()[k] + world.rig.camera_time_offset;
    SE3 a, b, c;
    if (!PoseAt(world.truth, t, &b) || !PoseAt(world.truth, t - 10'000, &a) ||
        !PoseAt(world.truth, t + 10'000, &c))
      continue;
    // One view, in the middle of a trajectory of its own.
    const Trajectory way{
        {t - options.longest, a}, {t - 10'000, a}, {t, b}, {t + 10'000, c}, {t + options.longest, c}};
    std::vector<MapView> views = PlanViews(map, world.rig, way, options);
    ViewFiller filler(&views);
    if (world.mirror_x || world.mirror_y) {
      filler.AddEvents(Mirrored(excerpts.events()[k], world));
    } else {
      filler.AddEvents(excerpts.events()[k]);
    }
    for (MapView& view : views) all.push_back(std::move(view));
  }
  return all;
}

double Explained(const MapEventOverlap& overlap) {
  return overlap.views > 0 && overlap.points >= kFewestOfAView * overlap.views ? overlap.kappa() : 0;
}

}  // namespace evit::diagnosis
