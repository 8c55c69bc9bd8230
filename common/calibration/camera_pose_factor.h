#pragma once

#include <ceres/sized_cost_function.h>

#include "common/geometry/se3.h"

namespace evit {

/// A camera pose measured in the map, against the body's state at the instant the stamp is believed to mean.
/// Parameters: pose (7) and motion (9) of the body in the upright frame at stamp + believed offset;
/// T_body_camera (7, PoseManifold); tilt (2, rad): the upright frame (gravity along -z) lies in the map as
/// Exp(tilt x, tilt y, 0); what is missing in the offset (1, s), over which the body moves on at its velocity
/// and rate. Rows: position (map frame, m) and rotation (camera frame, rad), divided by their sigmas.
class CameraPoseFactor : public ceres::SizedCostFunction<6, 7, 9, 7, 2, 1> {
 public:
  /// `gyro`: the raw reading at that instant, rad/s.
  CameraPoseFactor(const SE3& T_map_camera, const Eigen::Vector3d& gyro, double position_sigma,
                   double rotation_sigma)
      : measured_(T_map_camera), gyro_(gyro), w_p_(1 / position_sigma), w_r_(1 / rotation_sigma) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  SE3 measured_;
  Eigen::Vector3d gyro_;
  double w_p_, w_r_;
};

}  // namespace evit
