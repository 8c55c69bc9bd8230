#pragma once

#include <vector>

#include "common/diagnosis/finding.h"
#include "common/evaluation/trajectory.h"
#include "common/geometry/rig.h"
#include "common/imu/imu_sample.h"

namespace evit::diagnosis {

/// Do given poses of the body fit its IMU? Span, time offset, frame of the body, direction of gravity.
/// `truth`: T_map_body, IMU clock. `imu`: in the order of the recording.
Findings CheckTruth(const Trajectory& truth, const std::vector<ImuSample>& imu);

}  // namespace evit::diagnosis
