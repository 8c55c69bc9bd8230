#pragma once

#include "common/geometry/rig.h"
#include "common/tracking/alignment_misfit.h"
#include "common/tracking/state.h"
#include "common/tracking/tracker_options.h"

/// How well a pose is known. All are 6x6: position (m, map frame), then rotation (rad, right perturbation,
/// body frame).
namespace evit {

/// Covariance of the pose of a state whose inverse covariance is `information`.
Matrix6d PoseCovariance(const Matrix15d& information);

/// Systematic part of the covariance, which averaging over keyframes does not lower: the map's and the edges'
/// errors are the same in all of them. `share` of what one keyframe's alignment alone leaves open
/// (`alignment`: its information), at most some centimetres, and a shift of the whole map (m, per axis).
Matrix6d SystematicCovariance(const Matrix6d& alignment, double share, double map_sigma);

/// A common shift of image and map, which no keyframe shows because the pose absorbs it. What does show are
/// patches of the map beside their events (AlignmentMisfit); a median of a quarter pixel is the pixel grid's.
/// `share` times the rest as a standard deviation per axis, once as a shift of the map at its depth, once as
/// a turn of the camera.
Matrix6d MisfitCovariance(const AlignmentMisfit& misfit, double share, double focal_px);

/// Effect on the pose of an event latency that has not been measured (pixels' latency, clocks set by hand):
/// the body has moved on by then. `velocity`: m/s, map frame; `rate`: rad/s, body frame; `sigma`: of the
/// latency, s.
Matrix6d TimeOffsetCovariance(const Eigen::Vector3d& velocity, const Eigen::Vector3d& rate, double sigma);

/// Effect on the body's pose of an error of the rig's T_body_camera, of which T_body_camera_sigma tells. It
/// is the same during a whole run. Map and events determine the camera's pose; the body's is
/// T_map_camera * inverse(T_body_camera).
Matrix6d ExtrinsicsCovariance(const SE3& T_map_body, const Rig& rig);

/// Covariance of the pose of a state from all keyframes of a window, whose inverse covariance `information`
/// takes them as independent. They are not: each sees the edges that the last one saw, so velocity and biases
/// are off with the pose, and an estimate that the IMU alone carries drifts away faster than `information`
/// says.
Matrix6d WindowCovariance(const Matrix15d& information);

/// The same of velocity (m/s, map frame) and gyro bias (rad/s).
Matrix6d MotionCovariance(const Matrix15d& information);

/// The sum of these but for ExtrinsicsCovariance: how well the pose is known with exact extrinsics. The
/// trackers decide by it, and report it with ExtrinsicsCovariance added.
class PoseUncertainty {
 public:
  PoseUncertainty(const Camera& camera, const WindowOptions& options)
      : focal_px_(0.5 * (camera.fx + camera.fy)), options_(options) {}

  /// The newest keyframe that aligned with the map: `alignment` is the information of its events alone. Its
  /// systematic part stays until the next one. The misfit is the mean of the last ten's or so.
  void SetAlignment(const Matrix6d& alignment, const AlignmentMisfit& misfit);
  /// `random`: what keyframes so far leave open (WindowCovariance, or PoseCovariance of a single one).
  /// Velocity and rate as above.
  Matrix6d Covariance(const Matrix6d& random, const Eigen::Vector3d& velocity,
                      const Eigen::Vector3d& rate) const;
  /// The part of it that more keyframes would not lower.
  Matrix6d Systematic(const Eigen::Vector3d& velocity, const Eigen::Vector3d& rate) const;

 private:
  double focal_px_;
  WindowOptions options_;
  AlignmentMisfit misfit_;  // mean
  int n_misfits_ = 0;       // averaged in misfit_, at most kMisfits
  Matrix6d systematic_ = Matrix6d::Zero();
};

}  // namespace evit
