#pragma once

#include <vector>

#include "common/diagnosis/finding.h"
#include "common/evaluation/trajectory.h"
#include "common/imu/imu_sample.h"

namespace evit::diagnosis {

/// The mean of what an accelerometer reads, upwards: gravity, but for the speed gained on the way.
struct MeanForce {
  double up = 0;       // m/s^2
  double sigma = 0;    // m/s^2: of that, by the speed that may have been gained
  double seconds = 0;  // that it is the mean of; 0: too few samples
};
/// The gyro turns the readings of some seconds into one frame, whose mean is gravity but for the difference
/// of speeds at both ends; of windows one behind the other the vertical differences cancel. How fast the
/// sensor moves is taken from the readings themselves. Where `truth` (T_map_body, IMU clock, z up; may be
/// empty) knows the vertical speed at both ends, it is subtracted. `samples`: in the order of the recording.
MeanForce MeasureMeanForce(const std::vector<ImuSample>& samples, const Trajectory& truth);

/// Is the accelerometer's scale right? An error beyond what a bias of a consumer sensor explains, and four
/// sigma more: chance alone exceeds that in one of 16,000 recordings.
Finding CheckAccelScale(const std::vector<ImuSample>& samples, const Trajectory& truth, double gravity);

}  // namespace evit::diagnosis
