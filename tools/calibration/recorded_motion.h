#pragma once

#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/geometry/rig.h"
#include "common/imu/imu_sample.h"

namespace evit::calibration {

/// The IMU samples of an LCM log in the order they were recorded; readings that are beyond the sensor's range
/// by a tenth are left out, and messages that are not well-formed. Throws std::runtime_error naming the file
/// where there are none.
std::vector<ImuSample> ReadImu(const std::string& log, const ImuNoise& limits);

/// T_map_camera, stamped by the camera's own clock, from the body's poses that a tracker with this rig file
/// gave: its extrinsics and offset are taken out again.
Trajectory CameraOf(const Trajectory& body, const Rig& rig);

}  // namespace evit::calibration
