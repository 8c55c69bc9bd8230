#pragma once

#include <cstdint>

#include "common/tracking/localizer.h"

namespace evit {

/// How far off a start pose may be that was typed in by hand, or a lost tracker.
constexpr StartRange kStartRange{0.1, 0.09, 4};

/// The pose around `centre` at which a frame's events show the map most surely (AlignmentSignificance): of
/// localising from the centre, and from the best of many poses in the range of `range` around it. Never worse
/// than the centre itself. `frame`: each number tries other poses.
LocalizerResult SearchStart(const AlignmentSettings& settings, const SurfaceField& field,
                            const AlignmentPoints& points, const SE3& centre, const StartRange& range,
                            std::int64_t frame);

/// How a pose stands against the best other one that a search around it finds.
struct StartRival {
  bool distinct = false;    // it lies elsewhere, not in the same valley
  double significance = 0;  // of the pose over it (SignificanceOver)
  SE3 T_map_body;           // the other
};
/// Looks at some 4,000 points at most. `rounds`: of places to try around the pose, each with as many others.
StartRival FindRival(const AlignmentSettings& settings, const SurfaceField& field,
                     const AlignmentPoints& points, const SE3& T_map_body, const StartRange& range,
                     std::int64_t frame, int rounds = 1);

/// The same where the other one is looked for around `centre`, as far away as SearchStart() goes.
StartRival FindRivalAround(const AlignmentSettings& settings, const SurfaceField& field,
                           const AlignmentPoints& points, const SE3& T_map_body, const SE3& centre,
                           const StartRange& range, std::int64_t frame, int rounds);

}  // namespace evit
