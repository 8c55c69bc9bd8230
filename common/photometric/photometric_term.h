#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/se3.h"
#include "common/photometric/event_image.h"
#include "common/photometric/gradient_points.h"
#include "common/photometric/photometric_lanes.h"

namespace evit {

/// Motion of the body in the map frame: (velocity [m/s] of the body-fixed point that is at `origin`, angular
/// rate [rad/s]). About a fixed origin, so that it does not depend on the pose estimated along with it.
using Twist = Vector6d;

/// What the events of one frame say of pose and motion, at one level of coarseness.
struct PhotometricScene {
  SE3 T_camera_body;
  Camera camera;
  const EventImage* events = nullptr;
  int level = 0;
  std::vector<GradientPoint> points;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // m, map frame: of the twist
  double event_norm = 1;                             // of log intensity: what the event image is divided by
  double weight = 1;                                 // of one point's squared residual
  double robust_scale = 1;                           // of the Cauchy kernel, in units of the residual
  Matrix6d change =
      Matrix6d::Zero();  // mean of a a^T over the points, a: brightness change per unit of twist

  // The same for loops over lanes.
  AlignmentSettings seen_by;
  PhotometricPoints arrays;

  /// Fills `change` and what follows it. After points, origin, camera and its pose are set.
  void Prepare();
  /// d(brightness)/dt at the pixel that sees the point, per unit of twist: the change predicted is a . twist.
  Vector6d Change(const GradientPoint& g) const;
};

/// Value, gradient and Gauss-Newton Hessian of
///   sum over points of weight * rho(r^2) / 2,   r = E(pi(T, P)) / event_norm - a . xi / sqrt(xi^T change xi)
/// over the tangent (dp, dtheta) of T_map_body and the twist xi. Both images are divided by their size: the
/// contrast threshold and the speed do not matter (Bryner et al. 2019, Eq. (5); derived again). E: brightness
/// change by the events; a . xi: by the map's gradient, depth and the motion.
struct PhotometricTerm {
  double cost = 0;
  Eigen::Matrix<double, 12, 1> gradient = Eigen::Matrix<double, 12, 1>::Zero();
  Eigen::Matrix<double, 12, 12> hessian = Eigen::Matrix<double, 12, 12>::Zero();
};
PhotometricTerm EvaluatePhotometric(const PhotometricScene& scene, const SE3& T_map_body, const Twist& twist,
                                    bool derivatives);

/// The twist that explains the events best in the least-squares sense at this pose, given a prior of it, and
/// with it the size of the events at the points. `seconds`: length of the interval the events come from.
struct TwistFit {
  Twist twist = Twist::Zero();
  double event_rms = 0;  // of log intensity, over the points
};
TwistFit FitTwist(const PhotometricScene& scene, const SE3& T_map_body, double seconds, const Twist& prior,
                  const Vector6d& sigma);

/// Correlation of both images over the points, -1..1; `n_points`: of them in the image.
struct PhotometricQuality {
  double correlation = 0;
  int n_points = 0;
};
PhotometricQuality MeasurePhotometric(const PhotometricScene& scene, const SE3& T_map_body,
                                      const Twist& twist);

}  // namespace evit
