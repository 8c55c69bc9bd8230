// The tracker's start, and its recovery: event-only localisation of high-rate frames until velocities and
// biases can be told (paper Sec. III-C).
#include <algorithm>
#include <cstdio>
#include <utility>

#include "common/imu/preintegration.h"
#include "common/tracking/place_search.h"
#include "common/tracking/tracker.h"

namespace evit {
namespace {

constexpr int kStartLevels = 4;  // coarsest level 8 times smaller: a basin of some 30 pixels
constexpr int kFollowLevels = 3;
constexpr StartSigma kStartSigma{0.1, 0.09};     // a start pose typed in by hand; a lost tracker
constexpr StartSigma kFollowSigma{0.01, 0.006};  // constant velocity and gyro over some 10 ms
constexpr std::size_t kSureFrames = 3;
constexpr int kAnchorOnly = 5;       // frames, before places around the anchor are tried
constexpr int kPlaces = 96;          // of them for each frame
constexpr int kPlacePoints = 320;    // that they are compared by
constexpr double kNarrowest = 0.1;   // m: radius of the ball they lie in
constexpr double kWidest = 1;        // m
constexpr double kWidening = 0.004;  // m per frame, of some 10 ms
constexpr std::size_t kMaxFrames = 300;
constexpr int kPatience = 100;  // frames that do not fit before the start counts as failed

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

void Tracker::ProcessBootstrap(const KeyframeInput& keyframe, bool follows, TrackerOutput* out) {
  auto field = std::make_shared<SurfaceField>(keyframe.surface, kStartLevels);
  // Rotation from the gyro, which is good without any start-up; position from the last frames. Where there
  // are none, from the anchor: the last pose that was sure, turned by the gyro since. It does not move with
  // what was refused.
  std::shared_ptr<Preintegration> imu;
  if (follows) {
    imu = std::make_shared<Preintegration>(keyframe.imu, state_.bias, rig_.imu_noise);
    MoveAnchor(keyframe.imu);
  }
  const bool following = !frames_.empty() && imu != nullptr;
  SE3 predicted = following ? anchor_ : Guess(*field, keyframe.seq);
  if (following) {
    predicted.q = (state_.T_map_body.q * imu->delta().gamma).normalized();
    predicted.p = state_.T_map_body.p + imu->dt() * state_.velocity;
  }
  BodyState here = state_;
  here.T_map_body = predicted;
  AlignmentPoints points = SamplePoints(here, options_.points.per_keyframe, keyframe.seq);
  const StartSigma& sigma = following ? kFollowSigma : kStartSigma;
  const LocalizerResult fit =
      Localize(alignment_, *field, points, predicted, sigma, following ? kFollowLevels : kStartLevels);
  out->quality = fit.quality;
  out->iterations = fit.iterations;
  // A pose far from where it can be is a false minimum, however well the points happen to lie there: the gyro
  // knows the turn between two frames far better than any frame does.
  const bool plausible = (fit.T_map_body.p - predicted.p).norm() < 4 * sigma.position &&
                         AngularDistance(fit.T_map_body.q, predicted.q) < 4 * sigma.rotation;
  if (!plausible || !Aligned(fit.quality, options_.bootstrap.min_contrast)) {
    Refuse(points.size());
    return;
  }
  state_.T_map_body = fit.T_map_body;
  frames_.push_back({{keyframe.t, fit.T_map_body, imu}, keyframe.seq, field, points});
  if (frames_.size() > kMaxFrames) frames_.erase(frames_.begin());
  state_.velocity = RecentVelocity();
  if (state_.velocity.norm() > options_.failure.max_speed) {
    Refuse(points.size());
    return;
  }
  // A single frame finds some minimum nearly anywhere; several in a row that agree with gyro and constant
  // velocity do not.
  if (frames_.size() < kSureFrames) return;
  bad_frames_ = 0;
  anchor_ = fit.T_map_body;
  anchor_velocity_ = state_.velocity;
  reckoned_ = 0;
  if (mode_ == TrackerMode::kLost) SetMode(TrackerMode::kBootstrapping, "found the map again");
  reason_ = "localising high-rate frames";
  if (ReadyToBootstrap() && TryBootstrap()) {
    for (const WindowNode& n : window_.nodes()) out->nodes.push_back({n.t, n.seq, n.state});
  } else {
    out->nodes.push_back({keyframe.t, keyframe.seq, state_});
  }
  Finish(points, out);
}

// The anchor goes where the IMU says that the body goes: for a while all of it, then its rotation alone.
void Tracker::MoveAnchor(const std::vector<ImuSample>& samples) {
  constexpr Utime kLongest = 1'500'000;  // us: by then the position may be decimetres off
  const NavState moved = PropagateImu({anchor_, anchor_velocity_}, samples, state_.bias, rig_.gravity);
  anchor_.q = moved.T_map_body.q;
  // A velocity no body has comes from a reading that is none.
  if (reckoned_ >= kLongest || !(moved.velocity.norm() <= options_.failure.max_speed)) {
    anchor_velocity_.setZero();
    reckoned_ = kNoReckoning;
    return;
  }
  anchor_.p = moved.T_map_body.p;
  anchor_velocity_ = moved.velocity;
  reckoned_ += samples.back().t - samples.front().t;
}

// Where to look for the map next: at the anchor, and when that does not help where the map lies best of many
// places in a ball around it that grows as fast as a body may move, each frame others.
SE3 Tracker::Guess(const SurfaceField& field, std::int64_t seq) const {
  if (bad_frames_ <= kAnchorOnly) return anchor_;
  BodyState here = state_;
  here.T_map_body = anchor_;
  const double radius = std::min(kWidest, kNarrowest + kWidening * bad_frames_);
  return BestPlace(alignment_, field, SamplePoints(here, kPlacePoints, seq), anchor_, radius,
                   1 + kPlaces * bad_frames_, kPlaces);
}

void Tracker::Refuse(std::size_t n_points) {
  frames_.clear();  // the chain must have no holes
  state_.T_map_body = anchor_;
  state_.velocity = anchor_velocity_;
  ++bad_frames_;
  if (mode_ == TrackerMode::kLost) return;
  if (bad_frames_ <= kPatience) {
    reason_ = "waiting for events that fit the map";
  } else if (n_points < 30) {
    SetMode(
        TrackerMode::kLost,
        "no map points in view of the start pose: is the map in metres, and the start pose in its frame?");
  } else {
    SetMode(TrackerMode::kLost, "the map does not lie on the events around the start pose");
  }
}

Eigen::Vector3d Tracker::RecentVelocity() const {
  if (frames_.size() < 2) return Eigen::Vector3d::Zero();
  const BootstrapFrame& a = frames_[frames_.size() > 5 ? frames_.size() - 5 : 0].frame;
  const BootstrapFrame& b = frames_.back().frame;
  return (b.T_map_body.p - a.T_map_body.p) / ToSeconds(b.t - a.t);
}

bool Tracker::ReadyToBootstrap() const {
  const BootstrapOptions& c = options_.bootstrap;
  if (static_cast<int>(frames_.size()) < std::max(c.min_frames, 3)) return false;
  const BootstrapFrame &first = frames_.front().frame, &last = frames_.back().frame;
  const double moved = (last.T_map_body.p - first.T_map_body.p).norm();
  const double turned = AngularDistance(first.T_map_body.q, last.T_map_body.q);
  return moved >= c.min_displacement_m || turned >= c.min_rotation_deg * EIGEN_PI / 180 ||
         ToSeconds(last.t - first.t) >= c.max_duration_s;
}

bool Tracker::TryBootstrap() {
  std::vector<BootstrapFrame> chain;
  for (const LocalizedFrame& f : frames_) chain.push_back(f.frame);
  const BootstrapResult result =
      AlignVisualInertial(chain, rig_.gravity, options_.bootstrap, options_.window.imu_noise_factor);
  if (!result.success) {
    reason_ = "visual-inertial alignment refused: " + result.reason;
    frames_.erase(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(frames_.size() / 2));
    return false;
  }
  const auto n_window = std::min<std::size_t>(frames_.size(), options_.window.size);
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
  aligned_at_ = window_.nodes().back().t;
  SetMode(TrackerMode::kTracking, "bootstrapped");
  return true;
}

}  // namespace evit
