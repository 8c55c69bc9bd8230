#pragma once

#include <ceres/sized_cost_function.h>

#include "common/calibration/rig_prior.h"

namespace evit {

/// T_body_camera and time offset known beforehand. Parameters: T_body_camera (7, PoseManifold), s to add to
/// the offset (1). Rows: position (body frame), rotation (camera frame) and offset, whitened by
/// `information`.
class RigPriorFactor : public ceres::SizedCostFunction<7, 7, 1> {
 public:
  /// `late`: s, of the second parameter.
  RigPriorFactor(const SE3& T_body_camera, double late, const RigMatrix& information);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  SE3 mean_;
  double late_;
  RigMatrix root_;
};

}  // namespace evit
