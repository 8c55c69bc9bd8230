#pragma once

#include <vector>

#include "common/geometry/se3.h"
#include "common/mapping/edge_adjustment_options.h"
#include "common/mapping/posed_edges.h"

namespace evit {

/// Moves a view, within what is known of the pose that was `given`, to where the points that it sees lie on
/// its edges, which are looked for within `radius` pixels. Leaves it where it is if there is no solution.
void FitViewPose(const std::vector<MappedPoint>& points, double radius, const SE3& given,
                 const EdgeAdjustmentOptions& options, PosedEdges* view);

}  // namespace evit
