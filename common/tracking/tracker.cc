#include "common/tracking/tracker.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "common/tracking/image_speed.h"

namespace evit {
namespace {

constexpr std::size_t kMinPoints = 30;    // fewer say nothing about six unknowns
constexpr Utime kQueryAhead = 20'000;     // us ahead of the newest keyframe, where nothing better is known
constexpr Utime kFarthestAhead = 50'000;  // us: beyond that a prediction leaves the margin anyway

AlignmentSettings MakeAlignment(const Rig& rig, const config::Window& window) {
  AlignmentSettings settings;
  settings.set_camera(rig.camera);
  settings.T_camera_body = rig.T_body_camera.Inverse();
  settings.image_sigma = window.image_sigma();
  switch (window.kernel()) {
    case config::Window::HUBER:
      settings.kernel.kind = RobustKernel::Kind::kHuber;
      break;
    case config::Window::CAUCHY:
      settings.kernel.kind = RobustKernel::Kind::kCauchy;
      break;
    case config::Window::GEMAN_MCCLURE:
      settings.kernel.kind = RobustKernel::Kind::kGemanMcClure;
      break;
  }
  settings.kernel.scale = window.robust_scale() / window.image_sigma();
  return settings;
}

std::string Text(const char* format, double a, double b = 0) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

}  // namespace

Tracker::Tracker(const Rig& rig, const config::Tracker& config, const SE3& T_map_body)
    : rig_(rig),
      config_(config),
      alignment_(MakeAlignment(rig, config.window())),
      active_(rig.camera, rig.T_body_camera.Inverse(), static_cast<std::uint64_t>(config.points().seed())),
      window_(alignment_, rig.gravity, config.window()) {
  state_.T_world_body = anchor_ = T_map_body;
}

void Tracker::StartFrom(const BodyState& state) {
  state_ = state;
  anchor_ = state.T_world_body;
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
  SetMode(TrackerMode::kTracking, "resumed from a checkpoint");
}

void Tracker::SetMode(TrackerMode mode, std::string reason) {
  mode_ = mode;
  reason_ = std::move(reason);
}

void Tracker::Restart(const SE3& T_map_body, std::string reason) {
  state_.T_world_body = anchor_ = T_map_body;
  state_.velocity.setZero();
  frames_.clear();
  bad_keyframes_ = 0;
  SetMode(TrackerMode::kBootstrapping, std::move(reason));
}

VisibilityQuery Tracker::NextQuery() const {
  const double dt = ToSeconds(last_interval_ > 0 ? last_interval_ : kQueryAhead);
  SE3 pose = state_.T_world_body;
  pose.p += dt * state_.velocity;
  return QueryFrom(pose);
}

VisibilityQuery Tracker::QueryAfter(const KeyframeInput& keyframe) const {
  if (keyframe.imu.empty()) return NextQuery();
  const double dt = ToSeconds(std::clamp<Utime>(keyframe.t - state_time_, 0, kFarthestAhead));
  const BodyState predicted = Predict(keyframe);
  SE3 pose = predicted.T_world_body;
  pose.p += dt * predicted.velocity;
  pose.q = (pose.q * ExpSO3(dt * (keyframe.imu.back().gyro - state_.bias.gyro))).normalized();
  return QueryFrom(pose);
}

VisibilityQuery Tracker::QueryFrom(const SE3& T_map_body) const {
  const config::Points& points = config_.points();
  VisibilityQuery query;
  query.T_world_camera = T_map_body * rig_.T_body_camera;
  query.camera = rig_.camera;
  query.margin_px = points.margin_px();
  query.min_depth = points.min_depth_m();
  query.max_depth = points.max_depth_m();
  query.occlusion = points.occlusion();
  query.max_points = static_cast<int>(point_share_ * points.max_active());
  query.seed = static_cast<std::uint64_t>(points.seed());
  return query;
}

void Tracker::AddVisible(const std::vector<std::int32_t>& ids, const std::vector<Eigen::Vector3f>& points) {
  // What the last window saw stays, so that a point does not come and go with the random subset of each
  // answer.
  std::vector<SE3> poses{state_.T_world_body};
  if (mode_ == TrackerMode::kTracking) {
    for (const WindowNode& node : window_.nodes()) poses.push_back(node.state.T_world_body);
  }
  active_.Retain(poses, 0);
  if (active_.size() > 2 * static_cast<std::size_t>(config_.points().max_active())) active_.Clear();
  active_.Merge(ids, points);
}

bool Tracker::Aligned(const AlignmentQuality& quality) const {
  return quality.n_points >= static_cast<int>(kMinPoints) &&
         quality.contrast() >= config_.failure().min_contrast();
}

void Tracker::Finish(const AlignmentPoints& points, TrackerOutput* out) const {
  out->has_pose = true;
  out->image_speed = MedianImageSpeed(alignment_, points, state_.T_world_body, state_.velocity, rate_);
}

BodyState Tracker::Predict(const KeyframeInput& keyframe) const {
  BodyState predicted = state_;
  const double dt = ToSeconds(keyframe.t - state_time_);
  switch (config_.window().motion_model()) {
    case 0:
      break;
    case 1: {
      const auto& nodes = window_.nodes();
      if (nodes.size() < 2) break;
      const WindowNode &a = nodes[nodes.size() - 2], &b = nodes.back();
      const double s = dt / ToSeconds(b.t - a.t);
      const SE3 step = a.state.T_world_body.Inverse() * b.state.T_world_body;
      predicted.T_world_body.q = (state_.T_world_body.q * ExpSO3(s * LogSO3(step.q))).normalized();
      predicted.T_world_body.p += s * (b.state.T_world_body.p - a.state.T_world_body.p);
      break;
    }
    default: {
      const NavState nav =
          PropagateImu({state_.T_world_body, state_.velocity}, keyframe.imu, state_.bias, rig_.gravity);
      predicted.T_world_body = nav.T_world_body;
      predicted.velocity = nav.velocity;
    }
  }
  return predicted;
}

TrackerOutput Tracker::Process(const KeyframeInput& keyframe) {
  TrackerOutput out;
  if (!keyframe.imu.empty()) rate_ = keyframe.imu.back().gyro - state_.bias.gyro;
  if (Bridge(keyframe)) {
    if (mode_ == TrackerMode::kTracking) {
      ProcessTracking(keyframe, &out);
    } else {
      ProcessBootstrap(keyframe, &out);
    }
  }
  last_interval_ = state_time_ > 0 ? keyframe.t - state_time_ : 0;
  state_time_ = keyframe.t;
  out.mode = mode_;
  out.reason = reason_;
  return out;
}

// Handles the first keyframe and holes in the IMU stream. False: nothing more to do with this keyframe.
bool Tracker::Bridge(const KeyframeInput& keyframe) {
  if (state_time_ == 0) return true;
  const bool usable = keyframe.imu.size() >= 2 && keyframe.imu.front().t == state_time_ &&
                      keyframe.imu.back().t == keyframe.t;
  const double gap_ms =
      usable ? static_cast<double>(keyframe.imu_gap) * 1e-3 : 1e-3 * (keyframe.t - state_time_);
  if (usable && gap_ms <= config_.failure().max_imu_gap_ms()) return true;
  if (keyframe.t <= state_time_) return false;
  SE3 pose = state_.T_world_body;
  if (mode_ == TrackerMode::kTracking) pose.p += ToSeconds(keyframe.t - state_time_) * state_.velocity;
  Restart(pose, Text("IMU gap of %.0f ms: starting anew from the predicted pose", gap_ms));
  return true;
}

void Tracker::ProcessTracking(const KeyframeInput& keyframe, TrackerOutput* out) {
  WindowNode node;
  node.t = keyframe.t;
  node.seq = keyframe.seq;
  node.state = Predict(keyframe);
  node.field = std::make_shared<SurfaceField>(keyframe.surface, 1);
  node.points = active_.Sample(node.state.T_world_body,
                               static_cast<int>(point_share_ * config_.points().per_keyframe()),
                               static_cast<std::uint64_t>(keyframe.seq));
  node.imu = std::make_shared<Preintegration>(keyframe.imu, state_.bias, rig_.imu_noise);
  window_.Push(std::move(node));
  const SlidingWindow::Summary summary = window_.Solve();
  const WindowNode& newest = window_.nodes().back();
  state_ = newest.state;
  out->iterations = summary.iterations;
  out->quality = MeasureAlignment(alignment_, *newest.field, newest.points, state_.T_world_body);

  const config::Failure& limits = config_.failure();
  std::string trouble;
  if (!summary.usable) {
    trouble = "the solver failed";
  } else if (state_.velocity.norm() > limits.max_speed()) {
    trouble = Text("speed of %.1f m/s is over the limit of %.1f", state_.velocity.norm(), limits.max_speed());
  } else if (state_.bias.gyro.norm() > limits.max_gyro_bias() ||
             state_.bias.accel.norm() > limits.max_accel_bias()) {
    trouble = Text("biases too large: gyro %.3f rad/s, accel %.2f m/s^2", state_.bias.gyro.norm(),
                   state_.bias.accel.norm());
  }
  // Few events say little either way: such a keyframe lives on its IMU term and is no evidence of failure.
  const bool telling = keyframe.n_events >= config_.keyframes().min_events();
  bad_keyframes_ = Aligned(out->quality) || !telling ? 0 : bad_keyframes_ + 1;
  if (trouble.empty() && bad_keyframes_ > limits.max_bad_keyframes()) {
    trouble = newest.points.size() < kMinPoints
                  ? "no map points in view"
                  : Text("the map does not lie on the events (contrast %.2f, at least %.2f wanted)",
                         out->quality.contrast(), limits.min_contrast());
  }
  if (!trouble.empty()) {
    Restart(state_.T_world_body, "");
    SetMode(TrackerMode::kLost, trouble);
    return;
  }
  for (const WindowNode& n : window_.nodes()) out->nodes.push_back({n.t, n.seq, n.state});
  out->information = window_.NewestInformation();
  out->covariance = PoseCovariance(out->information);
  Finish(newest.points, out);
}

}  // namespace evit
