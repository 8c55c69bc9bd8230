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

/// How the angular rates of a trajectory fit those of a gyro: gyro = scale * R * (rate of the trajectory), at
/// the lag that fits best.
struct RateFit {
  Utime lag = 0;                                    // us to add to the trajectory's stamps
  double explained = 0;                             // share of the gyro's variance, there
  double explained_as_is = 0;                       // without lag
  double scale = 1;                                 // gyro over trajectory
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  // trajectory's body to gyro's, may be a mirror image
  int n = 0;                                        // instants compared; 0: none overlap
  double rate = 0;                                  // rad/s, rms of the trajectory
};
RateFit FitRates(const Trajectory& truth, const std::vector<ImuSample>& imu, Utime reach = 1'000'000);

}  // namespace evit::diagnosis
