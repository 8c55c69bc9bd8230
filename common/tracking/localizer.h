#pragma once

#include "common/tracking/event_alignment.h"

namespace evit {

/// Event-only localisation of a single frame (paper Eq. (3)), from coarse to fine.
struct LocalizerResult {
  SE3 T_world_body;
  AlignmentQuality quality;
  int iterations = 0;
};

/// `start`: within the basin of the coarsest level, some 2^(levels+1) pixels. `levels`: from 1 to
/// field.levels().
LocalizerResult Localize(const AlignmentSettings& settings, const SurfaceField& field,
                         const std::vector<Eigen::Vector3f>& points, const SE3& start, int levels,
                         int max_iterations = 15);

}  // namespace evit
