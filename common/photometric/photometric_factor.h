#pragma once

#include <ceres/sized_cost_function.h>

#include "common/photometric/photometric_term.h"

/// The terms of the photometric objective as Ceres cost functions, over a pose block (7 numbers,
/// PoseManifold) and a twist block (6).
namespace evit {

/// All points of a frame as one residual block, as EventAlignmentFactor does it: twelve rows with J^T J = H
/// and J^T r = g, and a constant one that makes |r|^2 / 2 the exact robust cost.
class PhotometricFactor : public ceres::SizedCostFunction<13, 7, 6> {
 public:
  /// `scene` must outlive this.
  explicit PhotometricFactor(const PhotometricScene* scene) : scene_(scene) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const PhotometricScene* scene_;
};

/// Pose and twist near those predicted. Sigmas: (position, rotation) and (velocity, rate), one standard
/// deviation per axis.
class MotionPriorFactor : public ceres::SizedCostFunction<12, 7, 6> {
 public:
  MotionPriorFactor(const SE3& pose, const Twist& twist, const Vector6d& pose_sigma,
                    const Vector6d& twist_sigma)
      : pose_(pose),
        twist_(twist),
        pose_weight_(pose_sigma.cwiseInverse()),
        twist_weight_(twist_sigma.cwiseInverse()) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  SE3 pose_;
  Twist twist_;
  Vector6d pose_weight_, twist_weight_;
};

}  // namespace evit
