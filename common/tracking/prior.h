#pragma once

#include "common/tracking/event_alignment.h"
#include "common/tracking/keyframe_link.h"

namespace evit {

/// What is known of one state from all that has left the window: a Gaussian in the tangent of `mean`.
struct StatePrior {
  BodyState mean;
  Matrix15d information = Matrix15d::Zero();
};

/// Its term of an objective at `state`: d^T information d / 2 with d = Minus(state, mean), and its
/// derivatives over the tangent of `state`.
struct PriorTerm {
  double cost;
  Vector15d gradient;
  Matrix15d hessian;
};
PriorTerm EvaluatePrior(const StatePrior& prior, const BodyState& state);

/// Removes the oldest state of a chain: combines its prior, its event alignment and what joins it to the
/// next state, linearised at the given estimates, into a prior on the next state (Schur complement). Because
/// only neighbours are joined, no other state is touched.
StatePrior Marginalize(const StatePrior& prior, const AlignmentTerm& alignment, const KeyframeLink& link,
                       const BodyState& i, const BodyState& j);

}  // namespace evit
