#pragma once

#include <optional>

#include "common/diagnosis/assumptions.h"
#include "common/diagnosis/event_excerpts.h"
#include "common/diagnosis/finding.h"
#include "common/map/map_index.h"
#include "common/overlap/map_event_overlap.h"

namespace evit::diagnosis {

/// Do the map's edges make events as they move over the image? Of good recordings, real and simulated, a
/// hundredth of the pixels and more fire while the image moves by some pixels, and a pixel that an edge moves
/// over gives an event in one of seven cases at least. Where the few events lie on the map all the same, its
/// place is right, and that so many points are without is the camera's fault. `given`: the world's overlap
/// within a pixel.
std::optional<Finding> CheckEventYield(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                                       const MapEventOverlap& given);

}  // namespace evit::diagnosis
