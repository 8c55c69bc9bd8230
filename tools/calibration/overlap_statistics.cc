#include "tools/calibration/overlap_statistics.h"

#include "common/text/format_text.h"
#include "tools/calibration/recorded_events.h"

namespace evit::calibration {
namespace {

// Share of the values below this grey level, %.
double Below(const SurfaceValues& surface, int level) {
  std::int64_t n = 0;
  for (int k = 0; k < level * SurfaceValues::kBins / 256; ++k) n += surface.histogram[k];
  return surface.points > 0 ? 100.0 * static_cast<double>(n) / static_cast<double>(surface.points) : 0;
}

}  // namespace

OverlapStatistics MeasureFiles(const OverlapFiles& files, const Rig& rig) {
  const Trajectory body = ReadTruth(files);
  MapViewOptions options;
  options.margin_px = 0;
  const std::vector<MapView> views = ReadViews(files, rig, body, options);
  OverlapStatistics s;
  s.overlap = MeasureOverlap(rig, views);
  SurfaceMeter meter(rig, &views);
  ForEachEventPacket(files.log, views.front().begin - kMicrosPerSecond / 2,
                     views.back().end + kMicrosPerSecond / 2,
                     [&](const EventArray& events) { meter.AddEvents(events); });
  meter.Finish();
  s.surface = meter.total();
  double seconds = 0;
  for (const MapView& view : views) {
    s.speed_px += view.speed_px / static_cast<double>(views.size());
    seconds += ToSeconds(view.end - view.begin);
    s.event_rate += static_cast<double>(view.n_events);
  }
  s.event_rate /= seconds;
  return s;
}

std::string StatisticsHeader() {
  return "| recording | image speed px/s | million events/s | events per edge pixel and px | points on "
         "events % (by chance) "
         "| events on map % (by chance) | surface under points | contrast | values below 64, 128, 192, 240 % "
         "|\n"
         "|---|---|---|---|---|---|---|---|---|\n";
}

std::string StatisticsRow(const std::string& name, const OverlapStatistics& s) {
  const MapEventOverlap& o = s.overlap;
  return FormatText(
      "| %s | %.0f | %.2f | %.2f | %.0f (%.0f) | %.0f (%.0f) | %.0f | %.2f | %.0f, %.0f, %.0f, %.0f |\n",
      name.c_str(), s.speed_px, 1e-6 * s.event_rate, o.events_per_edge_pixel(), 100 * o.point_share(),
      100 * o.point_share_by_chance(), 100 * o.event_share(), 100 * o.event_share_by_chance(),
      s.surface.mean(), s.surface.contrast(), Below(s.surface, 64), Below(s.surface, 128),
      Below(s.surface, 192), Below(s.surface, 240));
}

}  // namespace evit::calibration
