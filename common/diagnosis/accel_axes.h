#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/diagnosis/finding.h"
#include "common/evaluation/trajectory.h"
#include "common/imu/imu_sample.h"

namespace evit::diagnosis {

/// Which turn of the accelerometer's axes, or mirror image, fits the forces that known poses tell best.
struct AccelAxesFit {
  double as_read = 0;  // m/s^2, rms: difference of the readings and of the forces by the poses
  double best = 0;     // with the axes below
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // a signed permutation: axes * reading is right
  double tilted = 0;  // as read, with the poses turned in the map such that the mean points up
  int n = 0;          // instants compared
};
/// `truth`: T_map_body, IMU clock, z up. `gravity`: m/s^2.
AccelAxesFit FitAccelAxes(const std::vector<ImuSample>& samples, const Trajectory& truth, double gravity);

/// Are the accelerometer's axes those of the body? The poses' accelerations tell them also while gravity
/// stays along one axis.
Finding CheckAccelAxes(const std::vector<ImuSample>& samples, const Trajectory& truth, double gravity);

}  // namespace evit::diagnosis
