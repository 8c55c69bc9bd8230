#include "common/tracking/tracker.h"

#include <algorithm>
#include <utility>

#include "common/tracking/event_lag.h"
#include "common/tracking/image_speed.h"
#include "common/tracking/text.h"

namespace evit {
namespace {

constexpr Utime kQueryAhead = 20'000;  // us ahead of the newest keyframe, where nothing better is known
constexpr Utime kLongestGuess =
    500'000;  // us at constant velocity: beyond that the last pose is as good a guess
constexpr Utime kFarthestAhead = 50'000;  // us: beyond that a prediction leaves the margin anyway

AlignmentSettings MakeAlignment(const Rig& rig, const WindowOptions& window) {
  AlignmentSettings settings;
  settings.set_camera(rig.camera);
  settings.T_camera_body = rig.T_body_camera.Inverse();
  settings.image_sigma = window.image_sigma;
  settings.kernel.kind = window.kernel;
  settings.kernel.scale = window.robust_scale / window.image_sigma;
  return settings;
}

}  // namespace

Tracker::Tracker(const Rig& rig, const TrackerOptions& options, const SE3& T_map_body)
    : rig_(rig),
      options_(options),
      alignment_(MakeAlignment(rig, options.window)),
      active_(rig.camera, rig.T_body_camera.Inverse(), static_cast<std::uint64_t>(options.points.seed)),
      window_(alignment_, rig.gravity, options.window) {
  state_.T_map_body = anchor_ = T_map_body;
}

void Tracker::StartFrom(const BodyState& state) {
  state_ = state;
  anchor_ = state.T_map_body;
  anchor_velocity_ = state.velocity;
  reckoned_ = state.velocity.isZero() ? kNoReckoning : 0;
  reason_ = "going on from a checkpoint";
}

void Tracker::Resume(Utime t, const BodyState& state, const Matrix15d& information) {
  StartFrom(state);
  WindowNode node;
  node.t = state_time_ = t;
  node.state = state;
  // What its surface said is in the information already.
  const cv::Mat nothing(rig_.camera.height, rig_.camera.width, CV_8UC1, cv::Scalar(255));
  node.field = std::make_shared<SurfaceField>(nothing, 1);
  StatePrior prior;
  prior.mean = state;
  prior.information = information;
  window_.Reset({std::move(node)}, prior);
  aligned_at_ = t;
  SetMode(TrackerMode::kTracking, "resumed from a checkpoint");
}

void Tracker::SetMode(TrackerMode mode, std::string reason) {
  mode_ = mode;
  reason_ = std::move(reason);
}

void Tracker::Restart(const SE3& T_map_body, const Eigen::Vector3d& velocity, std::string reason) {
  state_.T_map_body = anchor_ = T_map_body;
  state_.velocity = anchor_velocity_ = velocity;
  reckoned_ = velocity.isZero() ? kNoReckoning : 0;
  frames_.clear();
  bad_frames_ = 0;
  SetMode(TrackerMode::kBootstrapping, std::move(reason));
}

VisibilityQuery Tracker::NextQuery() const {
  const double dt = ToSeconds(last_interval_ > 0 ? last_interval_ : kQueryAhead);
  SE3 pose = state_.T_map_body;
  pose.p += dt * state_.velocity;
  return QueryFrom(pose);
}

VisibilityQuery Tracker::QueryAfter(const KeyframeInput& keyframe) const {
  if (keyframe.imu.empty()) return NextQuery();
  const double dt = ToSeconds(std::clamp<Utime>(keyframe.t - state_time_, 0, kFarthestAhead));
  const BodyState predicted = Predict(keyframe);
  SE3 pose = predicted.T_map_body;
  pose.p += dt * predicted.velocity;
  pose.q = (pose.q * ExpSO3(dt * (keyframe.imu.back().gyro - state_.bias.gyro))).normalized();
  return QueryFrom(pose);
}

VisibilityQuery Tracker::QueryFrom(const SE3& T_map_body) const {
  const PointOptions& points = options_.points;
  VisibilityQuery query;
  query.T_map_camera = T_map_body * rig_.T_body_camera;
  query.camera = rig_.camera;
  query.margin_px = points.margin_px;
  query.min_depth = points.min_depth_m;
  query.max_depth = points.max_depth_m;
  query.occlusion = points.occlusion;
  query.max_points = static_cast<int>(point_share_ * points.max_active);
  query.seed = static_cast<std::uint64_t>(points.seed);
  return query;
}

void Tracker::AddVisible(const std::vector<std::int32_t>& ids, const std::vector<Eigen::Vector3f>& points) {
  // What the last window saw stays, so that a point does not come and go with the random subset of each
  // answer.
  std::vector<SE3> poses{state_.T_map_body};
  if (mode_ == TrackerMode::kTracking) {
    for (const WindowNode& node : window_.nodes()) poses.push_back(node.state.T_map_body);
  }
  active_.Retain(poses, 0);
  if (active_.size() > 2 * static_cast<std::size_t>(options_.points.max_active)) active_.Clear();
  active_.Merge(ids, points);
}

// Points for a keyframe that is expected there, where its events show them.
AlignmentPoints Tracker::SamplePoints(const BodyState& predicted, int count, std::int64_t seq) const {
  return WhereEventsShow(alignment_,
                         active_.Sample(predicted.T_map_body, count, static_cast<std::uint64_t>(seq)),
                         predicted.T_map_body, predicted.velocity, rate_, options_.lag_px);
}

bool Tracker::Aligned(const AlignmentQuality& quality, double min_contrast) {
  return quality.n_points >= static_cast<int>(kMinPoints) && quality.contrast() >= min_contrast;
}

void Tracker::Finish(const AlignmentPoints& points, TrackerOutput* out) const {
  out->has_pose = true;
  out->image_speed = MedianImageSpeed(alignment_, points, state_.T_map_body, state_.velocity, rate_);
}

BodyState Tracker::Predict(const KeyframeInput& keyframe) const {
  BodyState predicted = state_;
  const double dt = ToSeconds(keyframe.t - state_time_);
  switch (options_.window.motion_model) {
    case WindowOptions::MotionModel::kPreviousPose:
      break;
    case WindowOptions::MotionModel::kConstantVelocity: {
      const auto& nodes = window_.nodes();
      if (nodes.size() < 2) break;
      const WindowNode &a = nodes[nodes.size() - 2], &b = nodes.back();
      const double s = dt / ToSeconds(b.t - a.t);
      const SE3 step = a.state.T_map_body.Inverse() * b.state.T_map_body;
      predicted.T_map_body.q = (state_.T_map_body.q * ExpSO3(s * LogSO3(step.q))).normalized();
      predicted.T_map_body.p += s * (b.state.T_map_body.p - a.state.T_map_body.p);
      break;
    }
    case WindowOptions::MotionModel::kImu: {
      const NavState nav =
          PropagateImu({state_.T_map_body, state_.velocity}, keyframe.imu, state_.bias, rig_.gravity);
      predicted.T_map_body = nav.T_map_body;
      predicted.velocity = nav.velocity;
    }
  }
  return predicted;
}

TrackerOutput Tracker::Process(const KeyframeInput& keyframe) {
  TrackerOutput out;
  if (!keyframe.imu.empty() && !options_.event_only) rate_ = keyframe.imu.back().gyro - state_.bias.gyro;
  if (options_.event_only) {
    ProcessEventOnly(keyframe, &out);
    return out;
  }
  const bool follows = Follows(keyframe);
  if (mode_ == TrackerMode::kTracking) {
    ProcessTracking(keyframe, &out);
  } else {
    ProcessBootstrap(keyframe, follows, &out);
  }
  last_interval_ = state_time_ > 0 ? keyframe.t - state_time_ : 0;
  state_time_ = keyframe.t;
  out.mode = mode_;
  out.reason = reason_;
  return out;
}

// Whether the IMU tells how the body came here from the last keyframe. Where it does not, tracking starts
// anew.
bool Tracker::Follows(const KeyframeInput& keyframe) {
  if (state_time_ == 0) return false;
  const bool usable = keyframe.imu.size() >= 2 && keyframe.imu.front().t == state_time_ &&
                      keyframe.imu.back().t == keyframe.t;
  const double gap_ms =
      usable ? static_cast<double>(keyframe.imu_gap) * 1e-3 : 1e-3 * (keyframe.t - state_time_);
  if (usable && gap_ms <= options_.failure.max_imu_gap_ms) return true;
  SE3 pose = state_.T_map_body;
  if (keyframe.t <= state_time_) {
    Restart(pose, Eigen::Vector3d::Zero(),
            Text("the clock went back by %.0f ms: starting anew from the last pose", -gap_ms));
    return false;
  }
  const Utime unseen = keyframe.t - state_time_;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  if (mode_ == TrackerMode::kTracking && unseen <= kLongestGuess) {
    velocity = state_.velocity;
    pose.p += ToSeconds(unseen) * velocity;
    pose.q = (pose.q * ExpSO3(ToSeconds(unseen) * rate_)).normalized();
  }
  Restart(pose, velocity, Text("IMU gap of %.0f ms: starting anew from the predicted pose", gap_ms));
  return false;
}

}  // namespace evit
