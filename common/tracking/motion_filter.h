#pragma once

#include <Eigen/Core>

#include "common/geometry/se3.h"

namespace evit {

/// A Kalman filter of a body's pose and velocities, for poses that are found one by one without an IMU. The
/// body is expected to keep its velocities but for random accelerations (white noise).
class MotionFilter {
 public:
  struct State {
    SE3 T_map_body;
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, map frame
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();      // rad/s, body frame
  };

  /// Begins at a pose, with velocities unknown. `information`: inverse covariance over (dp, dtheta).
  void Start(const SE3& T_map_body, const Matrix6d& information);

  /// After `seconds` >= 0 from the newest pose.
  void Predict(double seconds);
  /// Of the pose, since Predict(): inverse covariance over (dp, dtheta).
  Matrix6d PoseInformation() const;
  /// The best pose there, given the prediction and something else that says `information` of it.
  void Update(const SE3& T_map_body, const Matrix6d& information);

  const State& state() const { return state_; }

 private:
  using Matrix12d = Eigen::Matrix<double, 12, 12>;

  State state_;
  Matrix12d covariance_ = Matrix12d::Identity();  // over (dp, dtheta, dv, drate)
};

}  // namespace evit
