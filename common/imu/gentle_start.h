#pragma once

#include <Eigen/Core>

namespace evit {

/// Tells a start so gentle that each quarter of a second looks the same: what the specific force differs from
/// that at rest, summed up over some seconds, is speed. The pose must not change meanwhile.
class GentleStart {
 public:
  /// The body is at rest. `force`: mean reading of the accelerometer, m/s^2.
  void Begin(const Eigen::Vector3d& force);

  /// Mean reading after `seconds` more. Whether the body has gained speed.
  bool Seen(const Eigen::Vector3d& force, double seconds);

 private:
  Eigen::Vector3d at_rest_ = Eigen::Vector3d::Zero();  // m/s^2; follows the drift of the accelerometer
  Eigen::Vector3d speed_ = Eigen::Vector3d::Zero();    // m/s, body frame; forgets
};

}  // namespace evit
