#pragma once

#include <vector>

#include "common/imu/propagation.h"

namespace evit {

/// Where bootstrapping looks for the map: the last pose that was sure, moved since as the IMU says that the
/// body moved. All of it for a while, then its rotation alone. What was rejected does not move it.
class Anchor {
 public:
  /// The body is here; its velocity is not known, so that the position stays.
  void Start(const SE3& T_map_body);
  /// `velocity`: m/s, map frame.
  void Start(const SE3& T_map_body, const Eigen::Vector3d& velocity);
  /// A velocity over `max_speed` (m/s) comes from a reading that is none: as if it were not known.
  void Move(const std::vector<ImuSample>& samples, const ImuBias& bias, double gravity, double max_speed);

  const SE3& pose() const { return state_.T_map_body; }
  const Eigen::Vector3d& velocity() const { return state_.velocity; }

 private:
  NavState state_;
  bool moves_ = false;  // its velocity is known
  Utime reckoned_ = 0;  // us: so long it has been moved by the IMU alone
};

}  // namespace evit
