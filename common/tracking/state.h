#pragma once

#include <Eigen/Core>
#include <array>

#include "common/geometry/se3.h"
#include "common/imu/imu_sample.h"
#include "common/time/utime.h"

namespace evit {

using Vector15d = Eigen::Matrix<double, 15, 1>;
using Matrix15d = Eigen::Matrix<double, 15, 15>;

/// State of the body at one keyframe (paper Eq. (1)). Tangent of 15: (dp, dtheta, dv, d gyro bias, d accel
/// bias).
struct BodyState {
  SE3 T_map_body;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, map frame
  ImuBias bias;
};

/// The same as parameter blocks for Ceres: pose (p, q as x y z w) and motion (v, gyro bias, accel bias).
struct StateBlocks {
  std::array<double, 7> pose{};
  std::array<double, 9> motion{};
};
StateBlocks ToBlocks(const BodyState& state);
BodyState FromBlocks(const StateBlocks& blocks);

/// Pose and motion behind raw parameter pointers.
SE3 PoseFromBlock(const double* pose);

/// Pose after `seconds` at the state's velocity and this angular rate (rad/s, body frame).
SE3 PoseAfter(const BodyState& state, const Eigen::Vector3d& rate, double seconds);

/// Difference b minus a in the tangent of a, 15 numbers.
Vector15d Minus(const BodyState& b, const BodyState& a);
/// `state` moved by a vector of its tangent.
BodyState Plus(const BodyState& state, const Vector15d& step);

}  // namespace evit
