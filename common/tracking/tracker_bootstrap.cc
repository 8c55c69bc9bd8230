// The tracker's start, and its recovery: event-only localisation of high-rate frames until velocities and
// biases can be told (paper Sec. III-C).
#include <algorithm>
#include <cstdio>
#include <utility>

#include "common/tracking/tracker.h"

namespace evit {
namespace {

constexpr int kStartLevels = 4;  // coarsest level 8 times smaller: a basin of some 30 pixels
constexpr int kFollowLevels = 3;
constexpr std::size_t kMaxFrames = 300;
constexpr int kPatience = 100;  // frames that do not fit before the start counts as failed

// Velocity over the last few localised frames: what constant-velocity prediction uses.
Eigen::Vector3d RecentVelocity(const std::vector<BootstrapFrame>& frames) {
  if (frames.size() < 2) return Eigen::Vector3d::Zero();
  const BootstrapFrame &a = frames[frames.size() > 5 ? frames.size() - 5 : 0], &b = frames.back();
  return (b.T_world_body.p - a.T_world_body.p) / ToSeconds(b.t - a.t);
}

// What the window may believe of its first state: the accuracy of an event-only pose and of the alignment.
StatePrior FirstPrior(const BodyState& state) {
  StatePrior prior;
  prior.mean = state;
  const auto set = [&](int row, double sigma) {
    prior.information.diagonal().segment<3>(row).setConstant(1 / (sigma * sigma));
  };
  set(0, 0.01), set(3, 0.01), set(6, 0.2), set(9, 0.01), set(12, 0.1);
  return prior;
}

}  // namespace

void Tracker::ProcessBootstrap(const KeyframeInput& keyframe, TrackerOutput* out) {
  auto field = std::make_shared<SurfaceField>(keyframe.surface, kStartLevels);
  // Rotation from the gyro, which is good without any start-up; position from the last frames.
  SE3 predicted = state_.T_world_body;
  const bool has_imu = state_time_ != 0 && keyframe.imu.size() >= 2;
  std::shared_ptr<Preintegration> imu;
  if (has_imu) {
    imu = std::make_shared<Preintegration>(keyframe.imu, state_.bias, rig_.imu_noise);
    predicted.q = (predicted.q * imu->delta().gamma).normalized();
    predicted.p += imu->dt() * state_.velocity;
  }
  std::vector<Eigen::Vector3f> points =
      active_.Sample(predicted, config_.points().per_keyframe(), static_cast<std::uint64_t>(keyframe.seq));
  const LocalizerResult fit =
      Localize(alignment_, *field, points, predicted, frames_.empty() ? kStartLevels : kFollowLevels);
  out->quality = fit.quality;
  out->iterations = fit.iterations;
  if (!Aligned(fit.quality)) {
    state_.T_world_body = predicted;
    ++bad_keyframes_;
    if (frames_.size() > 1 && bad_keyframes_ > config_.failure().max_bad_keyframes()) {
      frames_.clear();
      state_.velocity.setZero();
    }
    // The chain of frames must have no holes: what comes between is bridged by joining the IMU samples below.
    if (mode_ != TrackerMode::kLost && bad_keyframes_ > kPatience) {
      SetMode(TrackerMode::kLost, points.size() < 30
                                      ? "no map points in view of the start pose: is the map in metres, "
                                        "and the start pose in its frame?"
                                      : "the map does not lie on the events around the start pose");
    } else if (mode_ == TrackerMode::kBootstrapping && frames_.empty()) {
      reason_ = "waiting for events that fit the map";
    }
    if (!frames_.empty()) frames_.clear();
    return;
  }
  bad_keyframes_ = 0;
  state_.T_world_body = fit.T_world_body;
  frames_.push_back({{keyframe.t, fit.T_world_body, imu}, keyframe.seq, field, points});
  if (frames_.size() > kMaxFrames) frames_.erase(frames_.begin());
  std::vector<BootstrapFrame> chain;
  for (std::size_t k = frames_.size() > 5 ? frames_.size() - 5 : 0; k < frames_.size(); ++k) {
    chain.push_back(frames_[k].frame);
  }
  state_.velocity = RecentVelocity(chain);
  if (mode_ == TrackerMode::kLost && frames_.size() >= 5)
    SetMode(TrackerMode::kBootstrapping, "found the map again");
  if (mode_ == TrackerMode::kBootstrapping) {
    reason_ = "localising high-rate frames";
    if (ReadyToBootstrap() && TryBootstrap()) {
      for (const WindowNode& n : window_.nodes()) out->nodes.push_back({n.t, n.seq, n.state});
    }
  }
  if (mode_ == TrackerMode::kLost) return;
  if (out->nodes.empty()) out->nodes.push_back({keyframe.t, keyframe.seq, state_});
  Finish(points, out);
}

bool Tracker::ReadyToBootstrap() const {
  const config::Bootstrap& c = config_.bootstrap();
  if (static_cast<int>(frames_.size()) < std::max(c.min_frames(), 3)) return false;
  const BootstrapFrame &first = frames_.front().frame, &last = frames_.back().frame;
  const double moved = (last.T_world_body.p - first.T_world_body.p).norm();
  const double turned = AngularDistance(first.T_world_body.q, last.T_world_body.q);
  return moved >= c.min_displacement_m() || turned >= c.min_rotation_deg() * EIGEN_PI / 180 ||
         ToSeconds(last.t - first.t) >= c.max_duration_s();
}

bool Tracker::TryBootstrap() {
  std::vector<BootstrapFrame> chain;
  for (const LocalizedFrame& f : frames_) chain.push_back(f.frame);
  const BootstrapResult result =
      AlignVisualInertial(chain, rig_.gravity, config_.bootstrap(), config_.window().imu_noise_factor());
  if (!result.success) {
    reason_ = "visual-inertial alignment refused: " + result.reason;
    frames_.erase(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(frames_.size() / 2));
    return false;
  }
  const auto n_window = std::min<std::size_t>(frames_.size(), config_.window().size());
  std::deque<WindowNode> nodes;
  for (std::size_t k = frames_.size() - n_window; k < frames_.size(); ++k) {
    LocalizedFrame& f = frames_[k];
    nodes.push_back(
        {f.frame.t, f.seq, result.states[k], std::move(f.field), std::move(f.points), f.frame.imu});
  }
  const StatePrior prior = FirstPrior(nodes.front().state);
  window_.Reset(std::move(nodes), prior);
  window_.Solve();
  state_ = window_.nodes().back().state;
  frames_.clear();
  SetMode(TrackerMode::kTracking, "bootstrapped");
  return true;
}

}  // namespace evit
