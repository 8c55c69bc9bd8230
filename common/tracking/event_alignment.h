#pragma once

#include <Eigen/Core>

#include "common/geometry/lane_camera.h"
#include "common/geometry/rig.h"
#include "common/geometry/se3.h"
#include "common/tracking/alignment_points.h"
#include "common/tracking/robust_kernel.h"
#include "common/tracking/surface_field.h"
#include "common/tracking/tracker_options.h"

namespace evit {

/// The event alignment term of one keyframe (paper Eq. (3)): sum over points of rho((T(pi(P)) / sigma)^2)
/// / 2.
struct AlignmentSettings {
  SE3 T_camera_body;
  double image_sigma = 80;  // grey levels
  RobustKernel kernel;

  void set_camera(const Camera& camera) {
    camera_ = camera;
    lane_camera_ = LaneCamera(camera);
  }
  const Camera& camera() const { return camera_; }
  const LaneCamera& lane_camera() const { return lane_camera_; }

 private:
  Camera camera_;
  LaneCamera lane_camera_;
};

AlignmentSettings MakeAlignmentSettings(const Rig& rig, const WindowOptions& options);

/// Value, gradient and Hessian over the tangent (dp, dtheta) of T_map_body.
///
/// The Hessian is Newton's for each residual r over the image plane, slope * (grad r grad r^T + r [Hess r]+),
/// with the negative part of the surface's curvature left out so that it stays positive semi-definite.
/// Gauss-Newton's grad r grad r^T alone vanishes at the bottom of a valley, where the pose is known best: its
/// steps overshoot there, and it would tell a prior that nothing was learned.
struct AlignmentTerm {
  double cost = 0;
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
  Matrix6d hessian = Matrix6d::Zero();
};

/// A point behind the camera costs what an empty field (255) costs and pulls nowhere.
AlignmentTerm EvaluateAlignment(const AlignmentSettings& settings, const SurfaceField& field, int level,
                                const AlignmentPoints& points, const SE3& T_map_body, bool derivatives);

/// The same at level 0 with the cost's own curvature, made positive semi-definite only in the sum over
/// points: what one keyframe's events say of the pose, as an inverse covariance.
///
/// The Hessian above counts each point's positive curvature alone, and its gradient in full although a robust
/// kernel bends back. Steps by it are safe from anywhere, but on the rough surface of a real sensor noise
/// gives every point such a curvature somewhere, and the sum claims to know a pose of which the events say
/// little: steps along what they say least of are a fifth as long as they should be, and stop halfway. Here
/// the noise of many points cancels, and the valley that they share is left.
///
/// `bend`: where not null, gets the same curvature with all its eigenvalues made positive: how much the cost
/// bends either way, over a ridge as in a valley.
AlignmentTerm EvaluateAlignmentExactly(const AlignmentSettings& settings, const SurfaceField& field,
                                       const AlignmentPoints& points, const SE3& T_map_body,
                                       Matrix6d* bend = nullptr);

/// How well projected points sit on a surface's edges, against the same points shifted by some pixels: a
/// figure that needs no threshold on the scene's texture.
struct AlignmentQuality {
  int n_points = 0;         // points inside the image
  double mean_value = 255;  // 0..255 under the points
  double shifted_value =
      255;  // 0..255 under the points shifted by +-`shift` pixels in x and y, mean of the four
  double inlier_share = 0;  // 0..1: points whose value lies below half of 255

  /// 0: no better than elsewhere; towards 1: the points lie on edges and nothing around does.
  double contrast() const { return shifted_value > 0 ? 1.0 - mean_value / shifted_value : 0.0; }
};
struct BesideSamples;
/// The same of n points that have been sampled (batch_samples.h).
AlignmentQuality QualityOf(const BesideSamples& samples, std::size_t n);
AlignmentQuality MeasureAlignment(const AlignmentSettings& settings, const SurfaceField& field,
                                  const AlignmentPoints& points, const SE3& T_map_body, double shift = 10);

}  // namespace evit
