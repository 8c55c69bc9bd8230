#pragma once

#include "common/tracking/event_alignment.h"

namespace evit {

/// Events come late: a pixel fires only once its intensity has changed by a whole threshold since its last
/// event, and by then the edge has moved on. How far depends on edge and threshold in pixels, not on the
/// speed (docs/explanation/method.md).
///
/// Returns `points` (map frame, m) moved to where they seemed to be, `lag_px` pixels behind their motion over
/// the image, for a body at this pose, with this velocity (m/s, map frame) and angular rate (rad/s, body
/// frame).
AlignmentPoints CompensateEventLag(const AlignmentSettings& settings, AlignmentPoints points,
                                   const SE3& T_map_body, const Eigen::Vector3d& velocity,
                                   const Eigen::Vector3d& rate, double lag_px);

}  // namespace evit
