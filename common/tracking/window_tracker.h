#pragma once

#include <deque>
#include <string>
#include <vector>

#include "common/geometry/rig.h"
#include "common/imu/gentle_start.h"
#include "common/imu/steadiness.h"
#include "common/tracking/keyframe_input.h"
#include "common/tracking/point_selector.h"
#include "common/tracking/pose_covariance.h"
#include "common/tracking/rival_watch.h"
#include "common/tracking/sliding_window.h"
#include "common/tracking/start_probation.h"
#include "common/tracking/tracker_options.h"
#include "common/tracking/tracker_output.h"

namespace evit {

/// The tracker at work (paper Sec. III-D): each keyframe is predicted, aligned with the map together with
/// those before it in the sliding window, and accepted or rejected. While events say nothing about the pose,
/// the IMU alone carries it for a while, and for any time where it says that the body stands still.
class WindowTracker {
 public:
  /// `points` must outlive this.
  WindowTracker(const Rig& rig, const TrackerOptions& options, const AlignmentSettings& alignment,
                const PointSelector* points);

  /// With the nodes and the prior on the first of them that bootstrapping found.
  void Start(std::deque<WindowNode> nodes, const StatePrior& prior);
  /// With one keyframe whose state is known (`information`: its inverse covariance).
  void Start(Utime t, const BodyState& state, const Matrix15d& information);

  /// State at a keyframe that follows the newest, by the motion model.
  BodyState Predict(const KeyframeInput& keyframe) const;

  struct Result {
    std::string coasting;       // why the events do not count; empty where they do
    bool stands_still = false;  // the body does: where the events do not count, the pose stays
    std::string failure;        // why tracking cannot continue; empty where it can
    BodyState restart;          // where to look for the map in that case
  };
  /// Fills what `out` says of the newest state. `rate`: rad/s, body frame.
  Result Process(const KeyframeInput& keyframe, const Eigen::Vector3d& rate, TrackerOutput* out);

  /// Fills what `out` says of how well the newest state is known. `rate`: rad/s, body frame.
  void ReportUncertainty(const Eigen::Vector3d& rate, TrackerOutput* out) const;

  /// The part of the covariance that more keyframes would not lower.
  Matrix6d SystematicUncertainty(const Eigen::Vector3d& rate) const;

  /// us: mean time between the window's keyframes; 0 where there is only one.
  Utime MeanInterval() const;

  void set_solve_budget(double seconds) { window_.set_time_budget(seconds); }

  /// Newest estimate. At least one node, once started.
  const BodyState& state() const { return window_.nodes().back().state; }
  const std::deque<WindowNode>& nodes() const { return window_.nodes(); }

 private:
  void ForgetMotion();  // before a start: what later keyframes may not rely on
  void SetUncertainty(const WindowNode& newest);
  // Of the newest pose with exact extrinsics. What is decided goes by it: an error of the extrinsics neither
  // grows while the IMU alone carries the pose nor makes the map harder to find.
  Matrix6d CovarianceByMap(const Matrix15d& information, const Eigen::Vector3d& rate) const;
  WindowNode PredictedNode(const KeyframeInput& keyframe, const Eigen::Vector3d& rate) const;
  std::string WhyCoast(const KeyframeInput& keyframe, const AlignmentQuality& quality,
                       double significance) const;
  Utime Interval() const;
  bool StandsStill(const KeyframeInput& keyframe, const Eigen::Vector3d& rate);
  std::string WhyLost(const Result& result, const Matrix6d& covariance) const;

  Rig rig_;
  TrackerOptions options_;
  AlignmentSettings alignment_;
  const PointSelector* points_;
  SlidingWindow window_;
  PoseUncertainty uncertainty_;
  RivalWatch rivals_;
  StartProbation probation_;
  Steadiness steadiness_;
  GentleStart gentle_start_;
  bool started_gently_ = false;  // from a standstill, and no events have fitted since
  Utime coasted_ = 0;  // us: for how long the IMU alone has carried the pose, since events fitted last
};

}  // namespace evit
