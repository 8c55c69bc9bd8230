#pragma once

#include "common/tracking/event_alignment.h"

namespace evit {

/// What one keyframe's events say of the pose, as an inverse covariance over the tangent (dp [m], dtheta
/// [rad]) of T_map_body: the curvature of the alignment term's cost, signs and all, made positive
/// semi-definite only in the sum over points.
///
/// The Hessian that the solver steps by (AlignmentTerm) counts each point's positive curvature alone, and its
/// gradient in full although a robust kernel bends back. That makes every step safe, but on the rough surface
/// of a real sensor noise gives every point such a curvature somewhere, and the sum claims to know a pose of
/// which the events say little. Here the noise of many points cancels, and the valley that they share is
/// left.
Matrix6d AlignmentInformation(const AlignmentSettings& settings, const SurfaceField& field,
                              const AlignmentPoints& points, const SE3& T_map_body);

}  // namespace evit
