#pragma once

#include <ceres/sized_cost_function.h>

#include "common/geometry/se3.h"

namespace evit {

/// T_body_camera known beforehand. Parameter: T_body_camera (7, PoseManifold). Rows: position (body frame)
/// and rotation (camera frame), whitened by the information given (1/m^2, 1/rad^2).
class ExtrinsicPriorFactor : public ceres::SizedCostFunction<6, 7> {
 public:
  ExtrinsicPriorFactor(const SE3& T_body_camera, const Eigen::Matrix3d& position_information,
                       const Eigen::Matrix3d& rotation_information);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  SE3 mean_;
  Eigen::Matrix3d root_p_, root_r_;
};

}  // namespace evit
