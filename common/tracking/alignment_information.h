#pragma once

#include "common/tracking/event_alignment.h"

namespace evit {

/// What one keyframe's events say of the pose, as an inverse covariance over the tangent (dp [m], dtheta
/// [rad]) of T_map_body: the Hessian of EvaluateAlignmentExactly().
Matrix6d AlignmentInformation(const AlignmentSettings& settings, const SurfaceField& field,
                              const AlignmentPoints& points, const SE3& T_map_body);

}  // namespace evit
