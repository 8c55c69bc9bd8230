#pragma once

#include <string>

#include "common/tracking/event_alignment.h"
#include "common/tracking/localizer.h"
#include "common/tracking/state.h"
#include "common/tracking/tracker_options.h"

/// Acceptance gates: every test that an estimate has to pass before the trackers use it.
namespace evit {

constexpr int kMinPoints = 30;  // in view: fewer say nothing about six unknowns

/// Whether the map aligns with a keyframe's events: enough points in view, a significance
/// (AlignmentSignificance) of at least `min_significance` and, if `min_contrast` asks for it, clearly better
/// on the edges than beside them.
bool LiesOnEvents(const AlignmentQuality& quality, double min_contrast, double significance,
                  double min_significance);

/// Whether a localised pose lies where it can be, given the range it was looked for in: one far from there is
/// a false minimum, however well the points happen to lie. (The gyro knows the turn between two frames far
/// better than any frame does.)
bool WithinReach(const SE3& found, const SE3& predicted, const StartRange& range);

/// Describes the first physically impossible value of `state`, for a person; empty if it is plausible.
std::string WhyImplausible(const BodyState& state, const FailureOptions& limits);

}  // namespace evit
