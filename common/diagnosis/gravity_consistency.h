#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/imu/imu_sample.h"

namespace evit::diagnosis {

/// Does the gyro turn as the direction of gravity does? Between instants a second apart the direction of the
/// specific force, averaged over a fifth of a second, must turn against the body as the gyro says.
/// Accelerations blur that by some degrees; a gyro in other units, or with axes other than the
/// accelerometer's, contradicts it by tens.
struct GyroFit {
  double as_read = 0;  // rad: median disagreement with the gyro as it is
  double without = 0;  // rad: the same with a gyro that says nothing, which is how far gravity turned
  double best = 0;     // rad: the same with the best of the readings below
  double scale = 1;    // of that: 1, or pi/180 where the gyro is in degrees
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // of that: a signed permutation
  int pairs = 0;                                       // instants compared

  /// The gyro as read is contradicted, and another reading is not.
  bool Contradicted() const {
    return pairs >= 5 && without > 0.12 && as_read > 0.15 && best < 0.5 * as_read && best < 0.7 * without;
  }
  bool InDegrees() const { return scale < 0.5; }
};

/// `samples` in order of time. No pairs where there are less than two seconds of them.
GyroFit FitGyroToGravity(const std::vector<ImuSample>& samples);

}  // namespace evit::diagnosis
