#pragma once

#include <string>
#include <vector>

#include "common/tracking/bootstrapper.h"
#include "common/tracking/map_tracker.h"
#include "common/tracking/point_selector.h"
#include "common/tracking/window_tracker.h"

namespace evit {

/// Event-inertial tracking against a semi-dense map (paper Sec. III): bootstrapping, and then the sliding
/// window. This class says which of the two a keyframe goes to, and what mode that makes.
class Tracker final : public MapTracker {
 public:
  /// `T_map_body`: pose at the first keyframe, to some centimetres and degrees.
  Tracker(const Rig& rig, const TrackerOptions& options, const SE3& T_map_body);
  Tracker(const Tracker&) = delete;
  Tracker& operator=(const Tracker&) = delete;

  void Start(const SE3& T_map_body) override;
  void Start(const BodyState& state) override;
  void Start(Utime t, const BodyState& state, const Matrix15d& information) override;
  VisibilityQuery NextQuery() const override;
  VisibilityQuery QueryAfter(const KeyframeInput& keyframe) const override;
  VisibilityQuery QueryBeyond(const KeyframeInput& keyframe) const override;
  bool Suffices(const VisibilityQuery& answered, const VisibilityQuery& query) const override {
    return mode_ == TrackerMode::kTracking && points_.Suffice(answered, query);
  }
  void AddVisible(const std::vector<std::int32_t>& ids, const std::vector<Eigen::Vector3f>& points) override;
  void ForgetPoints() override { points_.Clear(); }
  TrackerOutput Process(const KeyframeInput& keyframe) override;
  void set_point_share(double share) override { points_.set_share(share); }
  void set_solve_budget(double seconds) override { window_.set_solve_budget(seconds); }
  TrackerMode mode() const override { return mode_; }
  const BodyState& state() const override;
  Utime state_time() const override { return state_time_; }
  /// Newest gyro reading less its bias.
  const Eigen::Vector3d& rate() const override { return rate_; }

 private:
  bool Follows(const KeyframeInput& keyframe) const;
  bool ImuReaches(const KeyframeInput& keyframe) const;
  double ImuGapMs(const KeyframeInput& keyframe) const;
  void StartAcrossGap(const KeyframeInput& keyframe);
  void StartBootstrapping(const BodyState& state, TrackerMode mode, std::string reason);
  void SetMode(TrackerMode mode, std::string reason);
  void Bootstrap(const KeyframeInput& keyframe, bool follows, TrackerOutput* out);
  void Track(const KeyframeInput& keyframe, TrackerOutput* out);
  void ReportWindow(TrackerOutput* out) const;
  VisibilityQuery QueryAfter(const KeyframeInput& keyframe, double further) const;
  void ReportPose(const AlignmentPoints& points, TrackerOutput* out);

  FailureOptions limits_;
  AlignmentSettings alignment_;
  PointSelector points_;
  Bootstrapper bootstrapper_;
  WindowTracker window_;
  TrackerMode mode_ = TrackerMode::kBootstrapping;
  std::string reason_ = "waiting for the first keyframe";
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();  // rad/s, body frame
  Utime state_time_ = 0;                            // us
  Utime last_interval_ = 0;                         // us, between the newest keyframes
  double image_speed_ = 0;                          // pixels/s, of the newest; 0: unknown
};

}  // namespace evit
