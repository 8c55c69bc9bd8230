#pragma once

#include <vector>

#include "common/geometry/rig.h"
#include "common/imu/imu_sample.h"
#include "tools/simulation/pose_spline.h"

namespace evit::simulation {

struct ImuSettings {
  double accel_bias = 0.06;  // m/s^2, length of the first bias (direction by chance)
  double gyro_bias = 0.006;  // rad/s
  double noise_factor = 1;   // of the rig's densities and random walks; 0: none
  // Vibration of the mount, 20 to 90 Hz, rms of an axis: far too small a motion for the camera to see.
  double vibration_accel = 0;  // m/s^2
  double vibration_gyro = 0;   // rad/s
};

struct SimulatedImu {
  std::vector<ImuSample> samples;
  std::vector<ImuBias> biases;  // of each sample
};

/// Reads an ideal IMU on the motion at the rig's rate, first sample at `begin`, then adds the calibrated
/// noise: per sample density / sqrt(dt), biases walk by random_walk * sqrt(dt). A sample is the instantaneous
/// value.
SimulatedImu SimulateImu(const PoseSpline& motion, const Rig& rig, const ImuSettings& settings, Utime begin,
                         Utime end, std::uint64_t seed);

}  // namespace evit::simulation
