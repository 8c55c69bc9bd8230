#pragma once

#include "common/tracking/event_alignment.h"

namespace evit {

/// Event-only localisation of a single frame (paper Eq. (3)), from coarse to fine.
struct LocalizerResult {
  SE3 T_map_body;
  AlignmentQuality quality;
  double significance = 0;  // AlignmentSignificance
  int iterations = 0;
};

/// How far the true pose may lie from the start, one standard deviation. A frame may say nothing about some
/// direction (all edges parallel, few events): without this it would drift away along it.
struct StartRange {
  double position = 0.1;   // m
  double rotation = 0.09;  // rad
  int levels = 4;          // of the field, to begin with the coarsest of: basins of some 2^(levels+1) pixels
};

/// Inverse covariance over (dp, dtheta).
Matrix6d InformationOf(const StartRange& range);

constexpr int kLocalizerIterations = 15;  // of the solver, for each level

LocalizerResult Localize(const AlignmentSettings& settings, const SurfaceField& field,
                         const AlignmentPoints& points, const SE3& start, const StartRange& range,
                         int max_iterations = kLocalizerIterations);

/// Localize() from each depth up to the range's, and the start itself: the pose that explains the frame most
/// surely (AlignmentSignificance). A coarse level may be as wide as the scene's own structure, or crowd all
/// points onto the densest events, and so leave a right pose; the search never ends worse than it began.
LocalizerResult LocalizeBest(const AlignmentSettings& settings, const SurfaceField& field,
                             const AlignmentPoints& points, const SE3& start, const StartRange& range);
/// The same where more is known of the pose: `information` is the start's inverse covariance over (dp,
/// dtheta).
LocalizerResult LocalizeBest(const AlignmentSettings& settings, const SurfaceField& field,
                             const AlignmentPoints& points, const SE3& start, const Matrix6d& information,
                             int levels);

}  // namespace evit
