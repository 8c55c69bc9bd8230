#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/imu/imu_sample.h"

namespace evit::diagnosis {

/// How the angular rates of a trajectory fit those of a gyro: gyro = scale * R * (rate of the trajectory), at
/// the lag that fits best.
struct RateFit {
  Utime lag = 0;                                    // us to add to the trajectory's stamps
  double explained = 0;                             // share of the gyro's variance, there
  double explained_as_is = 0;                       // without lag
  double explained_unturned = 0;                    // at the lag, with the axes as they are
  double scale = 1;                                 // gyro over trajectory
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  // trajectory's body to gyro's, may be a mirror image
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();   // rad/s: of the gyro, without R
  int n = 0;                                        // instants compared; 0: none overlap
  double rate = 0;                                  // rad/s, rms of the trajectory
};
RateFit FitRates(const Trajectory& truth, const std::vector<ImuSample>& imu, Utime reach = 1'000'000);

}  // namespace evit::diagnosis
