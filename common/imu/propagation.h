#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/geometry/se3.h"
#include "common/imu/imu_sample.h"

namespace evit {

/// Pose and velocity of the body, map frame.
struct NavState {
  SE3 T_map_body;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s
};

/// Moves a state forward over IMU samples (second-order motion model): the midpoint rule of Preintegration,
/// biases subtracted, gravity (0, 0, -gravity) added.
NavState PropagateImu(const NavState& state, const std::vector<ImuSample>& samples, const ImuBias& bias,
                      double gravity);

}  // namespace evit
