#pragma once

#include <map>
#include <optional>
#include <vector>

#include "common/diagnosis/assumptions.h"
#include "common/diagnosis/event_excerpts.h"
#include "common/map/map_index.h"
#include "common/overlap/misplacement.h"

namespace evit::diagnosis {

/// A misplacement, with how the map lies on the events once it is corrected.
struct PlacementFit {
  Misplacement misplacement;
  std::map<Utime, double> overlaps;  // of each view, of 1; key: its instant, us, events' clock
  double overlap = 0;                // of all together
  bool OneUnknown() const;
};

/// What good calibrations leave of a kind, and the latency of pixels in dim light; units as in Misplacement.
double Tolerance(Misplacement::Kind kind);

/// The world as it would be without the misplacement.
World Corrected(World world, const Misplacement& misplacement);

/// Views for fits: with the points that a correction by some percent would bring into view.
std::vector<MapView> PlacementViews(const MapIndex& map, const World& world, const EventExcerpts& excerpts);

/// Whether so many of the excerpts have one that something can be told.
bool EnoughViews(const std::vector<MapView>& views, const EventExcerpts& excerpts);

/// `views`: of `world`, which does not have the correction yet.
PlacementFit MeasurePlacement(const World& world, const std::vector<MapView>& views,
                              const Misplacement& misplacement);

/// By how many standard errors of the mean over the views `a` is better than `b`.
double Better(const PlacementFit& a, const PlacementFit& b);

/// The fit again from where it led to: what is in view there, the rest of its own kind, and a small rotation
/// or shift of no more than good calibrations leave. So kinds with one unknown compete with those of three,
/// which take up such a rest by themselves.
PlacementFit Refined(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                     const PlacementFit& fit);

/// The map's scale from starts so far off (a tenth to a quarter) that from here other points are in view.
std::optional<PlacementFit> FindFarScale(const MapIndex& map, const World& world,
                                         const EventExcerpts& excerpts);

}  // namespace evit::diagnosis
