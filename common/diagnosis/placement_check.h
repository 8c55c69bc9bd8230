#pragma once

#include "common/diagnosis/assumptions.h"
#include "common/diagnosis/event_excerpts.h"
#include "common/diagnosis/finding.h"
#include "common/map/map_index.h"

namespace evit::diagnosis {

/// By how much map, poses and camera are out of step, where it is a matter of amount: the map's scale, the
/// focal length, the camera's clock, its rotation, a shift of the map, the principal point.
struct PlacementCheck {
  bool misplaced = false;
  double overlap = 0;  // of 1, once that is corrected
  Findings findings;   // of the misplacement; where there is none, that scale and focal length are good
};

/// A misplacement counts where it is larger than what good calibrations leave, explains more than `best` (the
/// overlap, of 1, of any other explanation) and is better in view after view than none: by four times the
/// standard error of the mean over the views, which chance exceeds in two of a thousand recordings of ten
/// views. Among those that fit alike, within two standard errors, the one with the fewest unknowns is named,
/// and the others are mentioned.
PlacementCheck CheckPlacement(const MapIndex& map, const World& world, const EventExcerpts& excerpts,
                              double best);

}  // namespace evit::diagnosis
