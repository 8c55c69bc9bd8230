#pragma once

#include "common/tracking/event_alignment.h"

namespace evit {

/// Van der Corput's sequence: fills (0, 1) evenly, however far one goes.
double Halton(int k, int base);

/// Place `k` of an even covering of the ball of this radius (m) around the origin; 0 is its centre.
Eigen::Vector3d PlaceInBall(int k, double radius);

/// The pose, of `centre` and `count` more around it, at which the points lie best on the coarsest level of
/// the field: a start for Localize(). The rotation is the centre's, which a gyro keeps true while positions
/// are lost. Places are numbered on from `first`, so that the next frame can try others.
SE3 BestPlace(const AlignmentSettings& settings, const SurfaceField& field, const AlignmentPoints& points,
              const SE3& centre, double radius, int first, int count);

}  // namespace evit
