#pragma once

#include "common/tracking/event_alignment.h"
#include "common/tracking/point_selector.h"

namespace evit {

/// Element `k` of van der Corput's sequence in this base: any number of first elements fill (0, 1) evenly.
/// Sequences of different prime bases are the coordinates of Halton's points.
double Halton(int k, int base);

/// Place `k` of those that cover the ball of this radius (m) around the origin evenly; 0 is its centre.
Eigen::Vector3d PlaceInBall(int k, double radius);

/// Where to begin looking for the body in frame `seq`, after `rejected` frames in a row that did not fit the
/// map: at `anchor`, and after some frames at the best of many places in a ball around it. The ball grows
/// with each rejected frame, and each frame tries other places. A start for Localize().
SE3 InitialPose(const AlignmentSettings& settings, const PointSelector& points, const SurfaceField& field,
                const BodyState& anchor, const Eigen::Vector3d& rate, int rejected, std::int64_t seq);

/// The pose, of `centre` and `count` more around it, at which the points lie best on the coarsest level of
/// the field. All have the centre's rotation, which a gyro keeps true while the position is lost. `first`:
/// number of the first place (PlaceInBall), so that the next frame can try others.
SE3 BestPlace(const AlignmentSettings& settings, const SurfaceField& field, const AlignmentPoints& points,
              const SE3& centre, double radius, int first, int count);

}  // namespace evit
