#pragma once

#include "common/diagnosis/event_excerpts.h"
#include "common/diagnosis/finding.h"
#include "common/evaluation/trajectory.h"
#include "common/geometry/rig.h"
#include "common/map/map_index.h"

namespace evit::diagnosis {

/// Does the map lie on the events where the truth says that it must, and if not, what would make it so? Tried
/// are: the extrinsics inverted or turned, the truth's body being the camera, other time offsets, a mirrored
/// image, another resolution, axes of the map turned, and where it is nowhere near, its unit.
Findings CheckOverlap(const MapIndex& map, const Rig& rig, const Trajectory& truth,
                      const EventExcerpts& excerpts);

}  // namespace evit::diagnosis
