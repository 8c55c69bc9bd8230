#include "common/tracking/bootstrapper.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/geometry/degrees.h"
#include "common/tracking/alignment_significance.h"
#include "common/tracking/gates.h"
#include "common/tracking/localizer.h"
#include "common/tracking/place_search.h"
#include "common/tracking/start_search.h"

namespace evit {
namespace {

constexpr StartRange kStart{0.1, 0.09, 4};     // a start pose typed in by hand; a lost tracker
constexpr StartRange kFollow{0.01, 0.006, 3};  // constant velocity and gyro over some 10 ms
constexpr std::size_t kMaxFrames = 300;
constexpr std::size_t kLongestDoubt = 100;  // frames of a chain that may be false, before it is given up
constexpr int kRivalSearches = 3;    // before a start counts: one misses the right pose one time in eight
constexpr double kMostRanges = 4;    // that rivals are looked for in
constexpr double kWideSearch = 1.5;  // start errors: from here on the range of a start is too narrow
constexpr std::int64_t kBetweenSearches = 5;  // frames: another one may show a rival that the first did not
constexpr double kLongestWait = 2;            // s: for motion, where frames have few events
constexpr int kPatience = 100;                // frames that do not fit before the start counts as failed

// Of a start pose, in ranges of a start search.
double InRanges(double position, double rotation) {
  return std::max(position / kStart.position, rotation / kStart.rotation);
}

bool Beats(const StartRival& rival) { return rival.distinct && rival.significance <= 0; }

// What the window may believe of its first state: the accuracy of an event-only pose and of the alignment. Of
// the biases what was known before: a tenth of a second of frames says nothing of them, and what the
// alignment makes of the frames' noise (0.02 rad/s on recordings) would take seconds to go away.
StatePrior FirstPrior(const BodyState& state, const ImuBias& bias) {
  StatePrior prior;
  prior.mean = state;
  prior.mean.bias = bias;
  const auto set = [&](int row, double sigma) {
    prior.information.diagonal().segment<3>(row).setConstant(1 / (sigma * sigma));
  };
  set(0, 0.01), set(3, 0.01), set(6, 0.2), set(9, 0.01), set(12, 0.1);
  return prior;
}

}  // namespace

Bootstrapper::Bootstrapper(const Rig& rig, const TrackerOptions& options, const AlignmentSettings& alignment,
                           const PointSelector* points)
    : rig_(rig), options_(options), alignment_(alignment), points_(points) {}

void Bootstrapper::Start(const BodyState& state) {
  least_start_error_ = 1;
  Restart(state);
}

void Bootstrapper::Restart(const BodyState& state) {
  state_ = state;
  anchored_at_ = 0;
  if (state.velocity.isZero()) {
    anchor_.Start(state.T_map_body);
  } else {
    anchor_.Start(state.T_map_body, state.velocity);
  }
  frames_.clear();
  rejected_ = 0;
  unrivaled_ = false;
}

Bootstrapper::Result Bootstrapper::Process(const KeyframeInput& keyframe, bool follows,
                                           const Eigen::Vector3d& rate) {
  if (anchored_at_ == 0) anchored_at_ = keyframe.t;
  Result result;
  auto field = std::make_shared<SurfaceField>(keyframe.surface, kStart.levels);
  std::shared_ptr<Preintegration> imu;
  if (follows) {
    imu = std::make_shared<Preintegration>(keyframe.imu, state_.bias, rig_.imu_noise);
    anchor_.Move(keyframe.imu, state_.bias, rig_.gravity, options_.failure.max_speed);
  }
  // In a chain of frames: rotation from the gyro, which is good without any start-up, position from the last
  // frames. At its beginning: from the anchor.
  const bool chained = !frames_.empty() && imu != nullptr;
  const StartRange& range = chained ? kFollow : kStart;
  BodyState predicted = state_;
  if (chained) {
    predicted.T_map_body.q = (state_.T_map_body.q * imu->delta().gamma).normalized();
    predicted.T_map_body.p = state_.T_map_body.p + imu->dt() * state_.velocity;
  } else {
    predicted.T_map_body = anchor_.pose();
    predicted.T_map_body =
        InitialPose(alignment_, *points_, *field, predicted, rate, rejected_, keyframe.seq);
  }
  result.points = points_->Select(predicted, rate, points_->per_keyframe(), keyframe.seq);
  const LocalizerResult fit =
      chained ? LocalizeBest(alignment_, *field, result.points, predicted.T_map_body, range)
              : SearchStart(alignment_, *field, result.points, predicted.T_map_body, range, keyframe.seq);
  const double significance = fit.significance;
  result.quality = fit.quality;
  result.iterations = fit.iterations;
  if (!WithinReach(fit.T_map_body, predicted.T_map_body, range) ||
      !LiesOnEvents(fit.quality, options_.bootstrap.min_contrast, significance,
                    chained ? kFollowSignificance : kStartSignificance)) {
    RejectFrame(&result);
    return result;
  }
  state_.T_map_body = fit.T_map_body;
  if (frames_.empty()) BeginChain(keyframe.t);
  frames_.push_back({{keyframe.t, fit.T_map_body, imu},
                     keyframe.seq,
                     field,
                     result.points,
                     significance,
                     keyframe.n_events});
  if (frames_.size() > kMaxFrames) frames_.erase(frames_.begin());
  state_.velocity = RecentVelocity();
  if (state_.velocity.norm() > options_.failure.max_speed) {
    RejectFrame(&result);
    return result;
  }
  // A single frame finds some minimum nearly anywhere; several in a row that agree with gyro and constant
  // velocity do not.
  result.status = Result::Status::kUnsure;
  if (!unrivaled_) start_error_ = StartError();
  if (!Found()) {
    if (frames_.size() >= kLongestDoubt) RejectFrame(&result);
    return result;
  }
  if (!unrivaled_) unrivaled_ = RuleOutRivals(&result);
  if (!unrivaled_) return result;
  result.status = Result::Status::kLocalized;
  result.reason = "localising high-rate frames";
  // Only now the anchor moves: were the chain false, the anchor would have lost where the body was.
  rejected_ = 0;
  least_start_error_ = 1;
  anchor_.Start(fit.T_map_body, state_.velocity);
  anchored_at_ = keyframe.t;
  if (!ReadyToAlign()) return result;
  if (looked_at_ == keyframe.seq || RuleOutRivals(&result)) {
    Align(&result);
  } else if (frames_.empty()) {
    result.status = Result::Status::kUnsure;  // it starts again at the rival, which has proved nothing yet
  }
  return result;
}

void Bootstrapper::BeginChain(Utime t) {
  const SE3& anchor = anchor_.pose();
  chain_begin_.t = t;
  chain_begin_.position = state_.T_map_body.p - anchor.p;
  chain_begin_.rotation = AngularDistance(anchor.q, state_.T_map_body.q);
  chain_begin_.seconds = anchor_.velocity().isZero() ? ToSeconds(t - anchored_at_) : 0;
}

// What the body's motion before the chain, at the velocity that it has in the chain, does not explain of it.
double Bootstrapper::StartError() const {
  const BootstrapFrame &first = frames_.front().frame, &last = frames_.back().frame;
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  if (HasMoved()) {  // else that velocity is noise
    const Eigen::Vector3d velocity = (last.T_map_body.p - first.T_map_body.p) / ToSeconds(last.t - first.t);
    const double along = velocity.dot(chain_begin_.position) / std::max(velocity.squaredNorm(), 1e-12);
    moved = std::clamp(along, 0.0, std::max(chain_begin_.seconds, 0.0)) * velocity;
  }
  const double error = InRanges((chain_begin_.position - moved).norm(), chain_begin_.rotation);
  return std::clamp(error, least_start_error_, kMostRanges);
}

double Bootstrapper::MeanSignificance() const {
  double sum = 0;
  for (const LocalizedFrame& f : frames_) sum += f.significance;
  return sum / static_cast<double>(frames_.size());
}

// Whether the chain explains its events better than a false one does: a single frame of that may look as
// sure, ten in a row do not. A place that is farther off than a start may be has more to prove, unless the
// body moves: single frames lose a fast one soon, and so a false chain.
bool Bootstrapper::Found() const {
  const double times = unrivaled_ || HasMoved() ? 1 : start_error_;
  const double needed = std::min(times * options_.bootstrap.min_frames,
                                 std::max(0.5 * kLongestDoubt, 1.0 * options_.bootstrap.min_frames));
  return static_cast<double>(frames_.size()) >= needed && MeanSignificance() >= kFoundSignificance;
}

// A false lock may look as certain as the right pose while no other is known: before the first pose is
// reported, and again before the window takes over, no other pose may explain the newest frame as well. False
// where one does; where one explains it better the chain starts again from there.
bool Bootstrapper::RuleOutRivals(Result* result) {
  const LocalizedFrame& newest = frames_.back();
  looked_at_ = newest.seq;
  const auto find = [&](double times) {
    const StartRange range{times * kStart.position, times * kStart.rotation, kStart.levels};
    return FindRival(alignment_, *newest.field, result->points, state_.T_map_body, range, newest.seq,
                     static_cast<int>(std::lround(times * kRivalSearches)));
  };
  StartRival rival = find(1);
  // Where the start pose turned out to be wrong by more than a little, the right pose may be as far again.
  if (!Beats(rival) && start_error_ > kWideSearch) rival = find(start_error_);
  if (!Beats(rival)) return true;
  result->reason = "another pose explains the events as well";
  if (rival.significance < -kPreferredSignificance) {
    BodyState start = state_;
    start.T_map_body = rival.T_map_body;
    start.velocity.setZero();
    const SE3& anchor = anchor_.pose();
    const double error =
        InRanges((rival.T_map_body.p - anchor.p).norm(), AngularDistance(rival.T_map_body.q, anchor.q));
    // Once the anchor has moved to the false place, it says nothing of the start pose any more.
    least_start_error_ = std::clamp(error, unrivaled_ ? start_error_ : least_start_error_, kMostRanges);
    Restart(start);
  }
  return false;
}

void Bootstrapper::RejectFrame(Result* result) {
  frames_.clear();
  unrivaled_ = false;
  state_.T_map_body = anchor_.pose();
  state_.velocity = anchor_.velocity();
  ++rejected_;
  result->status = Result::Status::kRejected;
  result->reason = "waiting for events that fit the map";
  if (rejected_ <= kPatience) return;
  result->status = Result::Status::kHopeless;
  result->reason =
      result->points.size() < kMinPoints
          ? "no map points in view of the start pose: is the map in metres, and the start pose in its frame?"
          : "the map does not lie on the events around the start pose";
}

Eigen::Vector3d Bootstrapper::RecentVelocity() const {
  if (frames_.size() < 2) return Eigen::Vector3d::Zero();
  const BootstrapFrame& a = frames_[frames_.size() > 5 ? frames_.size() - 5 : 0].frame;
  const BootstrapFrame& b = frames_.back().frame;
  return (b.T_map_body.p - a.T_map_body.p) / ToSeconds(b.t - a.t);
}

bool Bootstrapper::HasMoved() const {
  const SE3 &first = frames_.front().frame.T_map_body, &last = frames_.back().frame.T_map_body;
  return (last.p - first.p).norm() >= options_.bootstrap.min_displacement_m ||
         AngularDistance(first.q, last.q) >= options_.bootstrap.min_rotation_deg * kRadiansPerDegree;
}

bool Bootstrapper::ReadyToAlign() const {
  if (static_cast<int>(frames_.size()) < std::max(options_.bootstrap.min_frames, 3)) return false;
  const double seconds = ToSeconds(frames_.back().frame.t - chain_begin_.t);
  if (HasMoved() || seconds >= std::max(kLongestWait, options_.bootstrap.max_duration_s)) return true;
  // Frames of few events know the velocity badly, and the window would coast on it until more come.
  double events = 0;
  for (const LocalizedFrame& f : frames_) events += f.n_events;
  return seconds >= options_.bootstrap.max_duration_s &&
         events >= static_cast<double>(frames_.size()) * options_.min_events &&
         frames_.back().seq - looked_at_ >= kBetweenSearches;
}

void Bootstrapper::Align(Result* result) {
  std::vector<BootstrapFrame> chain;
  for (const LocalizedFrame& f : frames_) chain.push_back(f.frame);
  const VisualInertialAlignment aligned =
      AlignVisualInertial(chain, rig_.gravity, options_.bootstrap, options_.window.imu_noise_factor);
  if (!aligned.success) {
    result->reason = "visual-inertial alignment rejected: " + aligned.reason;
    frames_.erase(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(frames_.size() / 2));
    chain_begin_.t = frames_.front().frame.t;  // the rest has to last as long again
    return;
  }
  const auto n_window = std::min<std::size_t>(frames_.size(), options_.window.size);
  for (std::size_t k = frames_.size() - n_window; k < frames_.size(); ++k) {
    LocalizedFrame& f = frames_[k];
    result->window.push_back(
        {f.frame.t, f.seq, aligned.states[k], std::move(f.field), std::move(f.points), f.frame.imu});
  }
  result->prior = FirstPrior(result->window.front().state, state_.bias);
  result->status = Result::Status::kAligned;
  frames_.clear();
}

}  // namespace evit
