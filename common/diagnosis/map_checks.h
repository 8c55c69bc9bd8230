#pragma once

#include <optional>
#include <vector>

#include "common/diagnosis/finding.h"
#include "common/evaluation/trajectory.h"
#include "common/events/event.h"
#include "common/geometry/rig.h"
#include "common/imu/imu_sample.h"
#include "common/map/map_index.h"

namespace evit::diagnosis {

/// Unit and size of a map.
Findings CheckMap(const PointMap& map);

/// Does a start pose (T_map_body) see the map, and stand upright in it? `imu`: the recording's, whose
/// beginning counts. `known`: where the body then is by known poses, if given.
Findings CheckStart(const MapIndex& map, const Rig& rig, const SE3& start, const std::vector<ImuSample>& imu,
                    const std::optional<SE3>& known);

}  // namespace evit::diagnosis
