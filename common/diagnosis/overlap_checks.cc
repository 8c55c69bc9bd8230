#include "common/diagnosis/overlap_checks.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/diagnosis/assumptions.h"
#include "common/diagnosis/clock_drift.h"
#include "common/diagnosis/event_yield.h"
#include "common/diagnosis/excerpt_views.h"
#include "common/diagnosis/hole_check.h"
#include "common/diagnosis/placement_check.h"
#include "common/overlap/map_event_overlap.h"
#include "common/text/format_text.h"

namespace evit::diagnosis {
namespace {

constexpr double kFits = 0.08;               // overlap, of 1: more is not chance
constexpr double kDoubtful = 0.2;            // good recordings have 0.2 and more
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

// The unit in which the map lies on the events, where one does as well as `best`, which it sets to its
// overlap.
std::optional<Finding> OtherUnit(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                                 double* best) {
  const std::pair<double, const char*> units[] = {{0.01, "centimetres"},
                                                  {0.001, "millimetres"},
                                                  {0.3048, "feet"},
                                                  {0.0254, "inches"},
                                                  {1000, "kilometres"}};
  for (const auto& [metres, name] : units) {
    PointMap scaled = map.map();
    for (Eigen::Vector3f& p : scaled.points) p *= static_cast<float>(metres);
    const double kappa = Explained(Measure(MapIndex(std::move(scaled)), world, excerpts));
    if (kappa < *best) continue;
    *best = kappa;
    return Finding{"map-unit", Severity::kError, FormatText("overlap %.2f, of 1, where it is scaled", kappa),
                   FormatText("The map is in %s: scaled by %g it lies on the events.", name, metres),
                   FormatText("convert it: `evit map import MAP --scale %g --out metres.pcd`", metres)};
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
      if (Explained(Measure(map, other, excerpts, 3)) < 0.8 * best) continue;
      const MapEventOverlap overlap = Measure(map, other, excerpts);
      if (2 * overlap.views < static_cast<std::int64_t>(excerpts.instants().size())) continue;
      if (Explained(overlap) > best + 0.02) best = Explained(overlap), offset = tried;
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

// Of the usual assumptions the one with which the map lies on the events best; null where none does better.
struct Usual {
  const Assumption* better = nullptr;
  double overlap = 0;  // of 1, with it
};

Usual FindUsual(const MapIndex& map, const World& as_is, const EventExcerpts& excerpts,
                const std::vector<Assumption>& all, double given) {
  Usual usual{nullptr, given};
  for (const Assumption& assumption : all) {
    World world = as_is;
    assumption.make(&world);
    // A third of the excerpts shows whether the assumption is hopeless.
    if (Explained(Measure(map, world, excerpts, 3)) < 0.8 * usual.overlap) continue;
    const MapEventOverlap overlap = Measure(map, world, excerpts);
    if (2 * overlap.views < static_cast<std::int64_t>(excerpts.instants().size())) continue;
    // Of equally good ones the first: the usual assumptions come first.
    if (Explained(overlap) > usual.overlap + 0.02) usual = {&assumption, Explained(overlap)};
  }
  return usual;
}

// Why the map does not lie on the events, where nothing that was tried puts it there.
Finding Nowhere(const MapEventOverlap& given, const std::string& figure) {
  const double points =
      given.views > 0 ? static_cast<double>(given.points) / static_cast<double>(given.views) : 0;
  if (points < kFewestOfAView) {
    return {
        "map-overlap", Severity::kError, FormatText("%.0f map points in view at the truth's poses", points),
        "At the truth's poses the camera sees almost nothing of the map: they are in different frames, or "
        "one has another scale.",
        "give truth and map in one frame, in metres: `evit map import --transform`, `--scale`"};
  }
  return {"map-overlap", Severity::kError, figure,
          "At the truth's poses the map lies on the events hardly better than by chance.",
          "`evit map check` shows pictures of it: another frame, another room, or a scale"};
}

}  // namespace

Findings CheckOverlap(const MapIndex& map, const Rig& rig, const Trajectory& truth,
                      const EventExcerpts& excerpts) {
  const World as_is{rig, Around(truth, excerpts, rig.camera_time_offset, 400'000)};
  const MapEventOverlap given = Measure(map, as_is, excerpts);
  const double kappa = Explained(given);
  if (std::optional<Finding> few = CheckEventYield(map, as_is, excerpts, given)) return {std::move(*few)};
  const std::vector<Assumption> all = Assumptions(rig);
  const Usual usual = FindUsual(map, as_is, excerpts, all, kappa);
  const bool mended =
      usual.better != nullptr && usual.overlap > kFits && usual.overlap > usual.better->gain * kappa + 0.03;
  const bool nowhere = given.views == 0 || kappa < kFits;
  double best = mended ? usual.overlap : kFits;
  std::optional<Finding> unit;
  if (nowhere || mended) unit = OtherUnit(map, as_is, excerpts, &best);
  // What is off by some amount fits better at that amount than at the nearest of the usual ones.
  PlacementCheck placement = CheckPlacement(map, as_is, excerpts, best);
  if (unit && !placement.misplaced) return {std::move(*unit)};
  if (kappa < kDoubtful || mended || placement.misplaced)
    if (std::optional<Finding> drift =
            CheckClockDrift(map, as_is, excerpts, std::max(best, placement.overlap)))
      return {std::move(*drift)};
  if (placement.misplaced) return std::move(placement.findings);
  const std::string figure =
      FormatText("%.0f %% of the points have events within a pixel (by chance %.0f %%)",
                 100 * given.point_share(), 100 * given.point_share_by_chance());
  if (mended) {
    return {
        {usual.better->check, kappa < 0.5 * usual.overlap ? Severity::kError : Severity::kWarning, figure,
         usual.better->what + FormatText(": then the map lies on the events (%.2f instead of %.2f, of 1).",
                                         usual.overlap, kappa),
         usual.better->remedy}};
  }
  if (nowhere) {
    const World longer{rig, Around(truth, excerpts, rig.camera_time_offset, kLongestOffset + 400'000)};
    if (std::optional<Finding> clock = OtherClock(map, longer, excerpts)) return {std::move(*clock)};
    return {Nowhere(given, figure)};
  }
  Findings found{Good("map-overlap", figure)};
  for (Finding& finding : placement.findings) found.push_back(std::move(finding));
  found.push_back(CheckHoles(map, as_is, excerpts));
  return found;
}

}  // namespace evit::diagnosis
