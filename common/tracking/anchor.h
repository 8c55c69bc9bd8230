#pragma once

#include <vector>

#include "common/imu/propagation.h"

namespace evit {

/// Where bootstrapping looks for the map: the last pose that was accepted, propagated by the IMU since: the
/// full pose at first, later its rotation only. Rejected frames do not move it.
class Anchor {
 public:
  /// The body is here; its velocity is not known, so that the position stays.
  void Start(const SE3& T_map_body);
  /// `velocity`: m/s, map frame.
  void Start(const SE3& T_map_body, const Eigen::Vector3d& velocity);
  /// A velocity over `max_speed` (m/s) is attributed to a bad reading and treated as unknown.
  void Move(const std::vector<ImuSample>& samples, const ImuBias& bias, double gravity, double max_speed);

  const SE3& pose() const { return state_.T_map_body; }
  const Eigen::Vector3d& velocity() const { return state_.velocity; }

 private:
  NavState state_;
  bool moves_ = false;       // its velocity is known
  Utime dead_reckoned_ = 0;  // us: how long it has been propagated by the IMU alone
};

}  // namespace evit
