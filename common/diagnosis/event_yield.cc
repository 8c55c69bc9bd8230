#include "common/diagnosis/event_yield.h"

#include "common/diagnosis/excerpt_views.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr double kOfPixels = 0.003, kOnEvents = 0.2;  // so few fire that nothing is told of the map
constexpr double kLeastYield = 0.06;  // events of a pixel that an edge moves over; good ones: 0.14 and more
constexpr double kOnMap = 0.15;       // of what fires, of 1: more than chance
constexpr double kOnPoints = 0.03;    // of the points, of 1: no more than by chance
constexpr double kCrowded = 0.8;      // of the image within reach of the map: then events are by chance, too

}  // namespace

std::optional<Finding> CheckEventYield(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                                       const MapEventOverlap& given) {
  MapViewOptions options;
  options.max_points = 200'000;  // all, for what edges cover of the image
  const MapEventOverlap overlap = MeasureOverlap(world.rig, ViewsOf(map, world, excerpts, 1, options));
  if (overlap.views == 0 || given.views == 0) return {};
  const Camera& camera = world.rig.camera;
  const double fired = static_cast<double>(overlap.fired) / static_cast<double>(overlap.views),
               yield = overlap.events_per_edge_pixel();
  const bool hardly_any = fired < kOfPixels * camera.width * camera.height && given.point_share() < kOnEvents;
  const bool in_place = overlap.event_kappa() > kOnMap && overlap.event_share_by_chance() < kCrowded;
  const bool few = hardly_any || (in_place && (yield < kLeastYield || given.kappa() < kOnPoints));
  if (!few) return {};
  return Finding{
      "event-rate", Severity::kError,
      FormatText("%.0f pixels fire in a view of the map; an edge gives %.2g events at a pixel it moves over",
                 fired, yield),
      "The camera moves, but edges make hardly any events: its thresholds are set too high, or it is dark.",
      "lower the camera's contrast thresholds (bias_diff_on, bias_diff_off), or give it more light"};
}

}  // namespace evit::diagnosis
