#pragma once

#include <string>
#include <vector>

#include "common/tracking/event_only_start.h"
#include "common/tracking/localizer.h"
#include "common/tracking/map_tracker.h"
#include "common/tracking/motion_filter.h"
#include "common/tracking/point_selector.h"
#include "common/tracking/pose_covariance.h"
#include "common/tracking/rival_watch.h"
#include "common/tracking/start_probation.h"

namespace evit {

/// EVT, event-only tracking: each frame is localised by its events alone, from the previous pose as the
/// paper's baseline (Sec. IV) does, or from where the body goes at its velocity, which then also holds what a
/// frame's events say little about (MotionFilter). Nothing of the IMU enters the pose. With a motion model it
/// starts as EVIT does, and watches for false poses as that does; the baseline says TRACKING from its first
/// frame on.
class EventOnlyTracker final : public MapTracker {
 public:
  /// `T_map_body`: pose at the first keyframe, to some centimetres and degrees.
  EventOnlyTracker(const Rig& rig, const TrackerOptions& options, const SE3& T_map_body);

  void Start(const SE3& T_map_body) override;
  void Start(const BodyState& state) override;
  void Start(Utime t, const BodyState& state, const Matrix15d& information) override;
  VisibilityQuery NextQuery() const override;
  VisibilityQuery QueryAfter(const KeyframeInput& keyframe) const override;
  bool Suffices(const VisibilityQuery& answered, const VisibilityQuery& query) const override {
    return (mode_ == TrackerMode::kTracking || moving_) && points_.Suffice(answered, query);
  }
  void AddVisible(const std::vector<std::int32_t>& ids, const std::vector<Eigen::Vector3f>& points) override;
  void ForgetPoints() override { points_.Clear(); }
  TrackerOutput Process(const KeyframeInput& keyframe) override;
  void set_point_share(double share) override { points_.set_share(share); }
  void set_solve_budget(double) override {}  // a frame's solve is short
  TrackerMode mode() const override { return mode_; }
  const BodyState& state() const override { return state_; }
  Utime state_time() const override { return state_time_; }
  /// From the newest two poses.
  const Eigen::Vector3d& rate() const override { return rate_; }

 private:
  bool KeepsVelocity() const {
    return options_.window.motion_model != WindowOptions::MotionModel::kPreviousPose;
  }
  bool Starting() const { return KeepsVelocity() && mode_ != TrackerMode::kTracking; }
  void StartAt(const SE3& T_map_body, TrackerMode mode, std::string reason);
  void StartAcrossHole(Utime t);
  void Search(const KeyframeInput& keyframe, TrackerOutput* out);
  void Follow(const KeyframeInput& keyframe, TrackerOutput* out);
  bool IsReachable(const SE3& T_map_body, double seconds) const;
  bool LooksAround(const SurfaceField& field, const AlignmentPoints& points, LocalizerResult* fit) const;
  MotionFilter::State MotionTo(const SE3& T_map_body, double seconds) const;
  void Accept(const KeyframeInput& keyframe, const MotionFilter::State& state);
  bool Proves(const KeyframeInput& keyframe, const SurfaceField& field, const AlignmentPoints& points,
              double significance);
  void Settle(EventOnlyStart::Status status, Utime t);
  bool Watch(const KeyframeInput& keyframe, double significance);
  void Report(const KeyframeInput& keyframe, const SurfaceField& field, const AlignmentPoints& points,
              const LocalizerResult& fit, const Matrix6d& alignment, TrackerOutput* out);
  void Reject(Utime t);

  Rig rig_;
  TrackerOptions options_;
  AlignmentSettings alignment_;
  PointSelector points_;
  PoseUncertainty uncertainty_;
  TrackerMode mode_ = TrackerMode::kBootstrapping;
  std::string reason_ = "waiting for the first keyframe";
  BodyState state_;      // at aligned_at_
  MotionFilter motion_;  // the same, while moving_
  bool moving_ = false;  // whether a filter of its motion has begun, which PREVIOUS_POSE has none of
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();  // rad/s, body frame
  Utime aligned_at_ = 0;                            // us: newest keyframe whose events the map lay on
  Utime state_time_ = 0;
  int rejected_ = 0;  // frames in a row that did not fit
  // With a motion model only:
  EventOnlyStart start_;
  StartProbation probation_;
  RivalWatch rivals_;
  Utime watched_at_ = 0;  // us: newest frame that these two have seen
};

}  // namespace evit
