#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/geometry/se3.h"
#include "common/time/utime.h"

namespace evit::simulation {

/// A smooth motion: uniform B-splines of degree 5 (four continuous derivatives), the position as a plain
/// spline, the rotation as a cumulative spline on SO(3) (Kim et al. 1995; derivatives after Sommer et al.,
/// "Efficient Derivative Computation for Cumulative B-Splines on Lie Groups", CVPR 2020).
class PoseSpline {
 public:
  static constexpr int kDegree = 5;
  static constexpr int kOrder = kDegree + 1;

  struct Sample {
    SE3 pose;                      // T_map_body
    Eigen::Vector3d velocity;      // of the body's origin, map frame, m/s
    Eigen::Vector3d acceleration;  // map frame, m/s^2
    Eigen::Vector3d rate;          // angular rate, body frame, rad/s
  };

  /// Least squares through the poses (in order of time, any rate), knots every `knot_spacing` seconds. Holes
  /// are bridged by a weak penalty on the jerk. Throws std::runtime_error where there are too few poses or
  /// the stamps do not increase.
  static PoseSpline Fit(const Trajectory& poses, double knot_spacing);

  Utime begin() const { return begin_; }
  Utime end() const { return end_; }

  /// Requires begin() <= t <= end().
  Sample Evaluate(Utime t) const;
  SE3 Pose(Utime t) const { return Evaluate(t).pose; }

  /// Seen from another frame: T_new_old * T_old_body(t).
  PoseSpline Moved(const SE3& T_new_old) const;

 private:
  struct Place {
    int first;  // control points first .. first + kDegree
    double u;   // 0..1 within the segment
  };
  Place Find(Utime t) const;
  /// Least squares: values at the poses [m x 3] to values of the control points [n x 3].
  using Solve = std::function<Eigen::MatrixX3d(const Eigen::MatrixX3d&)>;
  void FitRotations(const Trajectory& poses, const Solve& solve);

  Utime begin_ = 0, end_ = 0;
  double spacing_ = 0;  // s
  std::vector<Eigen::Vector3d> positions_;
  std::vector<Eigen::Quaterniond> rotations_;
};

/// Values of the kOrder basis functions (or their `derivative`-th derivatives in u) at u in 0..1.
std::array<double, PoseSpline::kOrder> SplineBasis(double u, int derivative);

}  // namespace evit::simulation
