#pragma once

#include "common/tracking/event_alignment.h"
#include "common/tracking/point_selector.h"

namespace evit {

/// Van der Corput's sequence: fills (0, 1) evenly, however far one goes.
double Halton(int k, int base);

/// Place `k` of an even covering of the ball of this radius (m) around the origin; 0 is its centre.
Eigen::Vector3d PlaceInBall(int k, double radius);

/// Where to look for the map in the next frame, `seq`, after so many that the map did not lie on: at
/// `anchor`, and when that has not helped, where the map lies best of many places in a ball around it. The
/// ball grows as fast as a body may move, and each frame tries others. A start for Localize().
SE3 InitialPose(const AlignmentSettings& settings, const PointSelector& points, const SurfaceField& field,
                const BodyState& anchor, const Eigen::Vector3d& rate, int rejected, std::int64_t seq);

/// The pose, of `centre` and `count` more around it, at which the points lie best on the coarsest level of
/// the field. The rotation is the centre's, which a gyro keeps true while positions
/// are lost. Places are numbered on from `first`, so that the next frame can try others.
SE3 BestPlace(const AlignmentSettings& settings, const SurfaceField& field, const AlignmentPoints& points,
              const SE3& centre, double radius, int first, int count);

}  // namespace evit
