#pragma once

#include "common/tracking/event_alignment.h"

namespace evit {

/// How far patches of the map lie beside their events at a pose, across their edges: what no pose can mend.
/// For each patch of the image (ImagePatches) the step, along the direction in which its cost curves most,
/// to the bottom of its valley. Beyond a valley's width there is no such step:
/// the median grows with what patches are off up to about a pixel, and no further.
struct AlignmentMisfit {
  int n_patches = 0;         // that say where they belong
  double offset_px = 0;      // median over these of the step's length
  double metres_per_px = 0;  // median over these of depth / focal length
};

AlignmentMisfit MeasureMisfit(const AlignmentSettings& settings, const SurfaceField& field,
                              const AlignmentPoints& points, const SE3& T_map_body);

}  // namespace evit
