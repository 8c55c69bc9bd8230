#pragma once

#include "common/tracking/event_alignment.h"

namespace evit {

/// Whether it can be chance that points lie better on a surface's edges than ten pixels beside them: the sum
/// over points of (mean value of the four places beside - value), in standard deviations of that sum, were it
/// chance alone.
///
/// Points on one edge err together, patches of the image hardly do: the standard deviation comes from the
/// sums of patches a 24th of the image's width wide. So the figure depends neither on how many events a
/// sensor gives nor on how many of the map's edges cause any, as AlignmentQuality's contrast does: of a right
/// pose that is 0.3 on one sensor and 0.06 on another. And it asks for edges, not for events: a pose that
/// crowds all points onto the densest spot gains nothing.
///
/// 0 where no point lies well inside the image.
double AlignmentSignificance(const AlignmentSettings& settings, const SurfaceField& field,
                             const AlignmentPoints& points, const SE3& T_map_body);

/// MeasureAlignment(), ten pixels beside, and AlignmentSignificance() in one: half the cost.
struct AlignmentVerdict {
  AlignmentQuality quality;
  double significance = 0;
};
AlignmentVerdict JudgeAlignment(const AlignmentSettings& settings, const SurfaceField& field,
                                const AlignmentPoints& points, const SE3& T_map_body);

/// The significance of pose `a` against pose `b`: how surely `a` explains the events better. Negative: `b`
/// does.
double SignificanceOver(const AlignmentSettings& settings, const SurfaceField& field,
                        const AlignmentPoints& points, const SE3& a, const SE3& b);

/// What a pose must reach while tracking, where the IMU supports it too. A false pose that was not found by a
/// search reaches it by chance once in 700 keyframes.
constexpr double kTrackingSignificance = 3;
/// The same for a frame that is localised from the frame before, by its events alone.
constexpr double kFollowSignificance = 4;
/// The same for the first frame, whose pose is the best of a wide search. On six real sequences the first
/// frames at the right pose had 4.8 to 11.6, half of them over 7.4; the best of searches 80 cm and 25 degrees
/// away from it 3.2, one in 25 over 5.
constexpr double kStartSignificance = 5;
/// The mean of several frames in a row before a start counts as found. On 15 starts of five real and two
/// simulated sequences at the right pose: 6.3 and more. (For a second after it: kFollowSignificance.)
constexpr double kFoundSignificance = 5.5;
/// Of one pose over another (SignificanceOver) before the first is preferred: chance reaches it once in 20.
constexpr double kPreferredSignificance = 2;

}  // namespace evit
