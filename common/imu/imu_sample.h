#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/time/utime.h"

namespace evit {

/// One raw reading, body frame.
struct ImuSample {
  Utime t = 0;                                      // us
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();   // rad/s, bias included
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();  // m/s^2, specific force, bias included
};

struct ImuBias {
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();   // rad/s
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();  // m/s^2
};

/// The reading at time t between a and b, linearly interpolated. Requires a.t <= t <= b.t and a.t < b.t.
ImuSample InterpolateImu(const ImuSample& a, const ImuSample& b, Utime t);

}  // namespace evit
