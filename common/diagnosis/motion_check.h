#pragma once

#include <vector>

#include "common/diagnosis/finding.h"
#include "common/evaluation/trajectory.h"
#include "common/imu/imu_sample.h"

namespace evit::diagnosis {

/// How a body moves on average (root mean square).
struct MeanMotion {
  double turning = 0;  // rad/s
  double speed = 0;    // m/s; 0 where only an IMU tells
  double shaking = 0;  // m/s^2, from one 20th of a second to the next; 0 where poses tell
  double seconds = 0;  // that it is the mean of; 0: too short to tell
  bool by_poses = false;
};
/// Of known poses, where they cover most of the IMU's time, else of the IMU. `truth`: T_map_body, IMU clock.
MeanMotion MeasureMotion(const std::vector<ImuSample>& samples, const Trajectory& truth);

/// Does the rig move enough that edges make events? Silent below a second.
Finding CheckMotion(const std::vector<ImuSample>& samples, const Trajectory& truth);

}  // namespace evit::diagnosis
