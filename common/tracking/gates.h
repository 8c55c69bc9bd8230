#pragma once

#include <string>

#include "common/tracking/event_alignment.h"
#include "common/tracking/localizer.h"
#include "common/tracking/state.h"
#include "common/tracking/tracker_options.h"

/// What the trackers believe, and what not. Every test that an estimate has to pass is here.
namespace evit {

constexpr int kMinPoints = 30;  // in view: fewer say nothing about six unknowns

/// Whether the map lies on a keyframe's events: enough points in view, and surely (AlignmentSignificance, at
/// least `min_significance`) and, where that is asked for, much more on edges than beside them.
bool LiesOnEvents(const AlignmentQuality& quality, double min_contrast, double significance,
                  double min_significance);

/// Whether a localised pose lies where it can be, given the range it was looked for in: one far from there is
/// a false minimum, however well the points happen to lie. (The gyro knows the turn between two frames far
/// better than any frame does.)
bool WithinReach(const SE3& found, const SE3& predicted, const StartRange& range);

/// What of a state no body does and no sensor has, for a person; empty where all is possible.
std::string WhatIsImpossible(const BodyState& state, const FailureOptions& limits);

}  // namespace evit
