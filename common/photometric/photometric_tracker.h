#pragma once

#include <string>
#include <utility>

#include "common/geometry/rig.h"
#include "common/photometric/photometric_options.h"
#include "common/photometric/photometric_solver.h"
#include "common/photometric/photometric_view.h"
#include "common/tracking/tracker_output.h"

namespace evit {

/// EVPT, the paper's photometric baseline (Bryner et al. 2019): brightness changes predicted from the
/// gradient of a photometric map, its depth and the camera's motion, against the events counted; over pose
/// and velocity, frame by frame. Nothing of the IMU is used. Ours, beyond it: a map rendered at the
/// prediction rather than key poses, coarse to fine, a robust kernel, and the speed, which two normalised
/// images leave open, from the contrast threshold and the velocity before.
class PhotometricTracker {
 public:
  /// `T_map_body`: pose at the first frame, to some centimetres and degrees.
  PhotometricTracker(const Rig& rig, const PhotometricTrackerOptions& options, const SE3& T_map_body);

  /// Whatever it was doing: the body is here.
  void Start(const SE3& T_map_body);

  /// The view that the next frame needs: from where the body is expected then.
  ViewQuery NextQuery() const;
  void SetView(PhotometricView view) { view_ = std::move(view); }

  /// Nodes: this frame's alone. Quality: inlier_share is the correlation of both images.
  TrackerOutput Process(const PhotometricFrame& frame);

  TrackerMode mode() const { return mode_; }
  const BodyState& state() const { return state_; }
  Utime state_time() const { return state_time_; }

 private:
  SE3 PoseAfter(const SE3& pose, double seconds) const;
  void Accept(const PhotometricFrame& frame, double after_events, const PhotometricSolution& solution,
              TrackerOutput* out);
  void Coast(const PhotometricFrame& frame, const SE3& predicted, const std::string& why, TrackerOutput* out);

  Rig rig_;
  PhotometricTrackerOptions options_;
  PhotometricSolver solver_;
  PhotometricView view_;
  TrackerMode mode_ = TrackerMode::kBootstrapping;
  std::string reason_ = "waiting for the first frame";
  BodyState state_;                                 // velocity: of the body's origin, map frame
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();  // rad/s, map frame
  double image_speed_ = 0;                          // pixels/s, 0: unknown
  Matrix6d covariance_ = Matrix6d::Identity();      // of the last good frame's pose,
                                                    // with exact extrinsics
  Utime state_time_ = 0, good_time_ = 0, last_interval_ = 0;
};

}  // namespace evit
