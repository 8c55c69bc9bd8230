#pragma once

#include "common/calibration/imu_track.h"
#include "common/evaluation/trajectory.h"

namespace evit {

/// How a camera's turning and a gyro's fit together.
struct RateAlignment {
  Eigen::Quaterniond q_body_camera = Eigen::Quaterniond::Identity();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();  // rad/s
  Utime offset = 0;                                     // us to add to the camera's stamps to get the IMU's
  double rms = 0;                                       // rad/s: what is left
  /// rad/s, falling: spread of the camera's rate along the principal axes of its turning. The rotation needs
  /// two of them well above `rms`, the offset one.
  Eigen::Vector3d spread = Eigen::Vector3d::Zero();
  int n = 0;  // intervals used; 0: too few, nothing else is set
};

/// Closed form: rotations of the camera over some 50 ms against the gyro's over the same time, shifted. For
/// each shift the rotation is Kabsch's and the bias the difference of the means (the same algebra as Umeyama
/// 1991 with rates for points); the shift is the one that leaves least, of all within `max_offset` us, then
/// refined by a parabola. `camera`: T_map_camera.
RateAlignment AlignRates(const Trajectory& camera, const ImuTrack& imu, Utime max_offset = 100'000);

}  // namespace evit
