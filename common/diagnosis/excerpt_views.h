#pragma once

#include <cstddef>
#include <vector>

#include "common/diagnosis/assumptions.h"
#include "common/diagnosis/event_excerpts.h"
#include "common/map/map_index.h"
#include "common/overlap/map_event_overlap.h"
#include "common/overlap/map_views.h"

namespace evit::diagnosis {

/// What the camera should see of the map at the middle of every `stride`-th excerpt, with the events that
/// fired there, as the world has it. Left out: where it has no poses, or `options` no points in view.
std::vector<MapView> ViewsOf(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                             std::size_t stride = 1, MapViewOptions options = {});

/// What "on" an event means where small offsets are to be told from none.
inline OverlapOptions WithinAPixel() {
  OverlapOptions options;
  options.radius_px = 1;
  options.both_ways = false;
  return options;
}

constexpr int kFewestOfAView = 50;  // map points, mean: by fewer EVIT would not track either

/// Its kappa(); 0 where the views hold too few points to tell: of a few, many may lie on events by chance.
double Explained(const MapEventOverlap& overlap);

}  // namespace evit::diagnosis
