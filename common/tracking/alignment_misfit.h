#pragma once

#include "common/tracking/event_alignment.h"

namespace evit {

/// Residual misalignment of map and events that no change of the pose can remove: for each patch of the image
/// (ImagePatches) the step to the bottom of its cost's valley, along the direction of strongest curvature.
/// Farther off than a valley's width there is no such step, so the median grows with the misalignment up to
/// about a pixel and no further.
struct AlignmentMisfit {
  int n_patches = 0;         // that say where they belong
  double offset_px = 0;      // median over these of the step's length
  double metres_per_px = 0;  // median over these of depth / focal length
};

AlignmentMisfit MeasureMisfit(const AlignmentSettings& settings, const SurfaceField& field,
                              const AlignmentPoints& points, const SE3& T_map_body);

}  // namespace evit
