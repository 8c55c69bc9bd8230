#pragma once

#include <optional>

#include "common/diagnosis/assumptions.h"
#include "common/diagnosis/event_excerpts.h"
#include "common/diagnosis/finding.h"
#include "common/map/map_index.h"

namespace evit::diagnosis {

/// Does the camera's clock run faster or slower than the truth's? Told where no single offset puts the map on
/// all views, but one that grows evenly does: clearly better than the best single one, and than `best` (the
/// overlap, of 1, of any other explanation).
std::optional<Finding> CheckClockDrift(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                                       double best);

}  // namespace evit::diagnosis
