#include "common/diagnosis/placement_fit.h"

#include <algorithm>
#include <cmath>

#include "common/diagnosis/excerpt_views.h"
#include "common/geometry/degrees.h"

namespace evit::diagnosis {
namespace {

using Kind = Misplacement::Kind;

}  // namespace

bool PlacementFit::OneUnknown() const {
  return misplacement.kind == Kind::kTime || misplacement.kind == Kind::kScale ||
         misplacement.kind == Kind::kFocal;
}

double Tolerance(Kind kind) {
  switch (kind) {
    case Kind::kTime:
      return 0.015;
    case Kind::kRotation:
      return 1 / kDegreesPerRadian;
    case Kind::kShift:
      return 0.03;
    case Kind::kCentre:
      return 4;
    default:
      return 0.02;
  }
}

World Corrected(World world, const Misplacement& misplacement) {
  Correct(misplacement, &world.rig, &world.truth);
  return world;
}

std::vector<MapView> PlacementViews(const MapIndex& map, const World& world, const EventExcerpts& excerpts) {
  MapViewOptions options;
  options.max_points = 1500;
  options.margin_px = 0.1 * world.rig.camera.width;
  return ViewsOf(map, world, excerpts, 1, options);
}

bool EnoughViews(const std::vector<MapView>& views, const EventExcerpts& excerpts) {
  return views.size() >= 5 && 2 * views.size() >= excerpts.instants().size();
}

PlacementFit MeasurePlacement(const World& world, const std::vector<MapView>& views,
                              const Misplacement& misplacement) {
  PlacementFit fit{misplacement, {}, 0};
  MapEventOverlap sum;
  for (const MapView& view : views) {
    const MapEventOverlap one =
        MeasureCorrected(world.rig, world.truth, {view}, misplacement, WithinAPixel());
    fit.overlaps[(view.begin + view.end) / 2] = one.kappa();
    sum.Add(one);
  }
  fit.overlap = Explained(sum);
  return fit;
}

double Better(const PlacementFit& a, const PlacementFit& b) {
  std::map<Utime, double> all = a.overlaps;  // a view without enough points has none
  for (const auto& [at, overlap] : b.overlaps) all[at] -= overlap;
  std::vector<double> gains;
  gains.reserve(all.size());
  for (const auto& [at, gain] : all) gains.push_back(gain);
  const auto n = static_cast<double>(gains.size());
  if (n < 2) return 0;
  double mean = 0, squares = 0;
  for (const double gain : gains) mean += gain / n;
  for (const double gain : gains) squares += (gain - mean) * (gain - mean);
  return mean / std::max(std::sqrt(squares / (n * (n - 1))), 1e-6);
}

PlacementFit Refined(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                     const PlacementFit& fit) {
  const Kind kind = fit.misplacement.kind;
  World there = Corrected(world, fit.misplacement);
  std::vector<MapView> views = PlacementViews(map, there, excerpts);
  const Misplacement rest = FindMisplacement(there.rig, there.truth, views, kind);
  const Misplacement all = Together(fit.misplacement, rest);
  if (!rest.value.isZero()) {
    there = Corrected(world, all);
    views = PlacementViews(map, there, excerpts);
  }
  PlacementFit best = MeasurePlacement(there, views, {});
  for (const Kind other : {Kind::kRotation, Kind::kShift}) {
    if (other == kind) continue;
    const Misplacement small = FindMisplacement(there.rig, there.truth, views, other);
    if (small.value.norm() > Tolerance(other)) continue;
    PlacementFit with = MeasurePlacement(there, views, small);
    if (with.overlap > best.overlap) best = std::move(with);
  }
  if (best.overlap < fit.overlap) return fit;
  best.misplacement = all;
  return best;
}

std::optional<PlacementFit> FindFarScale(const MapIndex& map, const World& world,
                                         const EventExcerpts& excerpts) {
  std::optional<PlacementFit> best;
  for (const double start : {-0.2, -0.1, 0.1, 0.25}) {
    const Misplacement far{Kind::kScale, {start, 0, 0}, 0};
    const World there = Corrected(world, far);
    const std::vector<MapView> views = PlacementViews(map, there, excerpts);
    const Misplacement rest = FindMisplacement(there.rig, there.truth, views, Kind::kScale);
    PlacementFit fit = MeasurePlacement(there, views, rest);
    fit.misplacement = Together(far, rest);
    if (EnoughViews(views, excerpts) && (!best || fit.overlap > best->overlap)) best = std::move(fit);
  }
  return best;
}

}  // namespace evit::diagnosis
