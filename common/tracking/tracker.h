#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/geometry/rig.h"
#include "common/map/map_index.h"
#include "common/tracking/active_points.h"
#include "common/tracking/bootstrap.h"
#include "common/tracking/localizer.h"
#include "common/tracking/sliding_window.h"
#include "common/tracking/tracker_options.h"

namespace evit {

enum class TrackerMode { kBootstrapping = 0, kTracking = 1, kLost = 2 };

/// What the tracker needs of one keyframe.
struct KeyframeInput {
  Utime t = 0;  // us
  std::int64_t seq = 0;
  int n_events = 0;            // since the previous keyframe
  cv::Mat surface;             // CV_8UC1, negated time surface
  std::vector<ImuSample> imu;  // from the previous keyframe's stamp to this one's, both ends included
  Utime imu_gap = 0;           // us: longest hole in those samples
};

struct NodeEstimate {
  Utime t = 0;
  std::int64_t seq = 0;
  BodyState state;
};

/// What came of one keyframe.
struct TrackerOutput {
  TrackerMode mode = TrackerMode::kBootstrapping;
  std::string reason;               // why it is in this mode
  bool has_pose = false;            // nodes.back() is this keyframe
  std::vector<NodeEstimate> nodes;  // the window, oldest first
  Matrix6d covariance = Matrix6d::Zero();
  Matrix15d information = Matrix15d::Zero();  // on the newest state, while tracking
  AlignmentQuality quality;
  int iterations = 0;
  double image_speed = 0;  // pixels/s, 0 where unknown
};

/// Event-inertial tracking against a semi-dense map: bootstrapping, prediction, active points, sliding window
/// and failure detection (paper Sec. III). Knows nothing of where keyframes and map points come from.
class Tracker {
 public:
  /// `T_map_body`: pose at the first keyframe, to some centimetres and degrees.
  Tracker(const Rig& rig, const TrackerOptions& options, const SE3& T_map_body);

  /// Looks for the map at this state instead, before the first keyframe: velocity and biases are trusted.
  void StartFrom(const BodyState& state);

  /// Whatever it was doing: the body is here, to some centimetres and degrees.
  void StartAnew(const SE3& T_map_body) {
    Restart(T_map_body, Eigen::Vector3d::Zero(), "starting anew from a pose hint");
  }
  /// Goes on tracking where another tracker was after its keyframe of time `t`, as if it were that one:
  /// `information` is TrackerOutput's. The next keyframe must follow that one.
  void Resume(Utime t, const BodyState& state, const Matrix15d& information);

  /// The view whose points the next keyframe needs.
  VisibilityQuery NextQuery() const;
  /// The same for the keyframe after this one, before it is processed: from its IMU samples, so that the
  /// answer comes while it is being processed. For use while tracking.
  VisibilityQuery QueryAfter(const KeyframeInput& keyframe) const;
  /// Answer to it. ids: indices into the map; points: map frame, m.
  void AddVisible(const std::vector<std::int32_t>& ids, const std::vector<Eigen::Vector3f>& points);

  TrackerOutput Process(const KeyframeInput& keyframe);

  /// Overload: use only so large a share of the configured points (0..1], and stop a solve after `seconds`
  /// with the best state so far (0: never). Neither is reproducible: for real time only.
  void set_point_share(double share) { point_share_ = share; }
  void set_solve_budget(double seconds) { window_.set_time_budget(seconds); }

  TrackerMode mode() const { return mode_; }
  /// Newest estimate: where IMU-rate poses are propagated from.
  const BodyState& state() const { return state_; }
  Utime state_time() const { return state_time_; }
  double gravity() const { return rig_.gravity; }
  /// Newest gyro reading less its bias, rad/s.
  const Eigen::Vector3d& rate() const { return rate_; }

 private:
  static constexpr Utime kNoReckoning = kMicrosPerSecond * 3600;  // velocity unknown: the anchor stays
  static constexpr std::size_t kMinPoints = 30;                   // fewer say nothing about six unknowns

  void ProcessBootstrap(const KeyframeInput& keyframe, bool follows, TrackerOutput* out);
  void ProcessTracking(const KeyframeInput& keyframe, TrackerOutput* out);
  void ProcessEventOnly(const KeyframeInput& keyframe, TrackerOutput* out);
  std::string Trouble(const KeyframeInput& keyframe, bool usable, const std::string& coasting,
                      const TrackerOutput& out);
  bool Follows(const KeyframeInput& keyframe);
  SE3 Guess(const SurfaceField& field, std::int64_t seq) const;
  void MoveAnchor(const std::vector<ImuSample>& samples);
  void Refuse(std::size_t n_points);
  Eigen::Vector3d RecentVelocity() const;
  bool ReadyToBootstrap() const;
  bool TryBootstrap();
  BodyState Predict(const KeyframeInput& keyframe) const;
  AlignmentPoints SamplePoints(const BodyState& predicted, int count, std::int64_t seq) const;
  VisibilityQuery QueryFrom(const SE3& T_map_body) const;
  static bool Aligned(const AlignmentQuality& quality, double min_contrast);
  void SetMode(TrackerMode mode, std::string reason);
  /// Velocity zero: unknown.
  void Restart(const SE3& T_map_body, const Eigen::Vector3d& velocity, std::string reason);
  void Finish(const AlignmentPoints& points, TrackerOutput* out) const;

  Rig rig_;
  TrackerOptions options_;
  AlignmentSettings alignment_;
  ActivePoints active_;
  SlidingWindow window_;
  TrackerMode mode_ = TrackerMode::kBootstrapping;
  std::string reason_ = "waiting for the first keyframe";
  BodyState state_;
  SE3 anchor_;                                                 // where bootstrapping looks for the map
  Eigen::Vector3d anchor_velocity_ = Eigen::Vector3d::Zero();  // m/s, map frame
  Utime reckoned_ = kNoReckoning;  // us: so long the anchor has been moved by the IMU alone
  Utime state_time_ = 0;
  Utime last_interval_ = 0;
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();  // rad/s: newest gyro reading less its bias
  int bad_frames_ = 0;                              // high-rate frames in a row that did not fit
  Utime aligned_at_ = 0;                            // newest keyframe whose events the map lay on
  Matrix6d common_ = Matrix6d::Zero();              // CommonCovariance of the newest aligned keyframe
  double point_share_ = 1;

  struct LocalizedFrame {  // high-rate frame kept until the window takes over
    BootstrapFrame frame;
    std::int64_t seq;
    std::shared_ptr<const SurfaceField> field;
    AlignmentPoints points;
  };
  std::vector<LocalizedFrame> frames_;
};

}  // namespace evit
