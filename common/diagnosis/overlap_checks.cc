#include "common/diagnosis/overlap_checks.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/diagnosis/assumptions.h"
#include "common/diagnosis/excerpt_views.h"
#include "common/diagnosis/hole_check.h"
#include "common/diagnosis/placement_check.h"
#include "common/overlap/map_event_overlap.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr double kFits = 0.08;               // overlap, of 1: more is not chance
constexpr Utime kLongestOffset = 1'000'000;  // us, of the camera's clock

// The poses within `reach` us of the excerpts.
Trajectory Around(const Trajectory& truth, const EventExcerpts& excerpts, Utime time_offset, Utime reach) {
  Trajectory part;
  for (const StampedPose& s : truth) {
    const auto near = [&](Utime t) { return std::abs(s.t - t - time_offset) < reach; };
    if (std::any_of(excerpts.instants().begin(), excerpts.instants().end(), near)) part.push_back(s);
  }
  return part;
}

// Of every `stride`-th excerpt.
MapEventOverlap Measure(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                        std::size_t stride = 1) {
  MapViewOptions options;
  options.max_points = 1500;
  return MeasureOverlap(world.rig, ViewsOf(map, world, excerpts, stride, options), WithinAPixel());
}

// The unit in which the map lies on the events, where one does better than `best`.
std::optional<Finding> OtherUnit(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                                 double best) {
  const std::pair<double, const char*> units[] = {{0.01, "centimetres"},
                                                  {0.001, "millimetres"},
                                                  {0.3048, "feet"},
                                                  {0.0254, "inches"},
                                                  {1000, "kilometres"}};
  for (const auto& [metres, name] : units) {
    PointMap scaled = map.map();
    for (Eigen::Vector3f& p : scaled.points) p *= static_cast<float>(metres);
    const MapEventOverlap overlap = Measure(MapIndex(std::move(scaled)), world, excerpts);
    if (overlap.views == 0 || overlap.kappa() < best) continue;
    return Finding{"map-unit", Severity::kError,
                   FormatText("overlap %.2f, of 1, where it is scaled", overlap.kappa()),
                   FormatText("The map is in %s: scaled by %g it lies on the events.", name, metres),
                   FormatText("convert it: `evit map import --scale %g`", metres)};
  }
  return {};
}

// How far off the camera's clock is, by tenths of a second, where the map then lies on the events: the gyro
// says nothing of it while the camera turns evenly.
std::optional<Finding> OtherClock(const MapIndex& map, const World& world, const EventExcerpts& excerpts) {
  constexpr Utime kStep = 25'000, kTried = 100'000;  // us; less is an assumption of its own
  double best = kFits;
  Utime offset = 0;
  for (Utime size = kTried + kStep; size <= kLongestOffset; size += kStep) {
    for (const Utime tried : {size, -size}) {
      World other = world;
      other.rig.camera_time_offset += tried;
      if (Measure(map, other, excerpts, 3).kappa() < 0.8 * best) continue;
      const MapEventOverlap overlap = Measure(map, other, excerpts);
      if (2 * overlap.views < static_cast<std::int64_t>(excerpts.instants().size())) continue;
      if (overlap.kappa() > best + 0.02) best = overlap.kappa(), offset = tried;
    }
  }
  if (offset == 0) return {};
  return Finding{
      "time-offset", Severity::kError,
      FormatText("overlap of map and events %.2f, of 1, where it is put right", best),
      FormatText("The camera's clock is some %.0f ms off the truth's.", 1e3 * ToSeconds(offset)),
      FormatText(
          "set `time_offset_us: %.0f` in the rig file's camera, then let `evit calibrate` find it exactly",
          static_cast<double>(world.rig.camera_time_offset + offset))};
}

// Of good recordings, real and simulated, a hundredth of the pixels and more fire while the image moves by
// some pixels, and the points of a map that lies on them have events.
std::optional<Finding> TooFewEvents(const MapEventOverlap& given, const Camera& camera) {
  constexpr double kOfPixels = 0.003, kOnEvents = 0.2;
  const double fired =
      given.views > 0 ? static_cast<double>(given.fired) / static_cast<double>(given.views) : 0;
  if (given.views == 0 || fired > kOfPixels * camera.width * camera.height || given.point_share() > kOnEvents)
    return {};
  return Finding{
      "event-rate", Severity::kError,
      FormatText("%.0f pixels fire in a view of the map, %.0f %% of its points have events within a pixel",
                 fired, 100 * given.point_share()),
      "The camera moves, but edges make hardly any events: its thresholds are set too high, or it is dark.",
      "lower the camera's contrast thresholds (bias_diff_on, bias_diff_off), or give it more light"};
}

}  // namespace

Findings CheckOverlap(const MapIndex& map, const Rig& rig, const Trajectory& truth,
                      const EventExcerpts& excerpts) {
  const World as_is{rig, Around(truth, excerpts, rig.camera_time_offset, 400'000)};
  const MapEventOverlap given = Measure(map, as_is, excerpts);
  const double kappa = given.views > 0 ? given.kappa() : 0;
  if (const std::optional<Finding> few = TooFewEvents(given, rig.camera)) return {*few};
  const Assumption* better = nullptr;
  double best = kappa;
  const std::vector<Assumption> all = Assumptions(rig);
  for (const Assumption& assumption : all) {
    World world = as_is;
    assumption.make(&world);
    // A third of the excerpts shows whether the assumption is hopeless.
    if (Measure(map, world, excerpts, 3).kappa() < 0.8 * best) continue;
    const MapEventOverlap overlap = Measure(map, world, excerpts);
    if (2 * overlap.views < static_cast<std::int64_t>(excerpts.instants().size())) continue;
    // Of equally good ones the first: the usual assumptions come first.
    if (overlap.kappa() > best + 0.02) best = overlap.kappa(), better = &assumption;
  }
  const std::string figure =
      FormatText("%.0f %% of the points have events within a pixel (by chance %.0f %%)",
                 100 * given.point_share(), 100 * given.point_share_by_chance());
  const bool mended = better != nullptr && best > kFits && best > better->gain * kappa + 0.03;
  // What a map far too large shows of itself is so little that some turn of it fits by chance.
  const bool nowhere = given.views == 0 || kappa < 0.03;
  if (nowhere)
    if (const std::optional<Finding> unit = OtherUnit(map, as_is, excerpts, std::max(kFits, best)))
      return {*unit};
  // What is off by some amount fits better at that amount than at the nearest of the usual ones.
  PlacementCheck placement = CheckPlacement(map, as_is, excerpts, mended ? best : kFits);
  if (placement.misplaced) return std::move(placement.findings);
  if (mended) {
    return {{better->check, kappa < 0.5 * best ? Severity::kError : Severity::kWarning, figure,
             better->what +
                 FormatText(": then the map lies on the events (%.2f instead of %.2f, of 1).", best, kappa),
             better->remedy}};
  }
  if (nowhere) {
    const World longer{rig, Around(truth, excerpts, rig.camera_time_offset, kLongestOffset + 400'000)};
    if (const std::optional<Finding> clock = OtherClock(map, longer, excerpts)) return {*clock};
  }
  if (given.views == 0) {
    return {{"map-overlap", Severity::kError, "no map points in view at the truth's poses",
             "At the truth's poses the camera sees nothing of the map: they are in different frames.",
             "give truth and map in one frame: `evit map import --transform`"}};
  }
  if (kappa < 0.03) {
    return {{"map-overlap", Severity::kError, figure,
             "At the truth's poses the map lies on the events no better than by chance.",
             "`evit map check` shows pictures of it: another frame, another room, or a scale"}};
  }
  Findings found{Good("map-overlap", figure)};
  for (Finding& finding : placement.findings) found.push_back(std::move(finding));
  found.push_back(CheckHoles(map, as_is, excerpts));
  return found;
}

}  // namespace evit::diagnosis
