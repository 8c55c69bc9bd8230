#include "common/tracking/event_only_tracker.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/tracking/alignment_significance.h"
#include "common/tracking/event_alignment.h"
#include "common/tracking/gates.h"
#include "common/tracking/image_speed.h"
#include "common/tracking/localizer.h"

namespace evit {
namespace {

constexpr StartRange kRange{0.05, 0.05, 3};  // how far a body may get between two frames, and then some
constexpr double kFrameError = 0.03;         // m: that a frame's pose may have besides
// Neighbouring frames show the same edges, at 300 Hz mostly by the same events: errors of ten are about
// one's.
constexpr double kFrameShare = 0.1;   // of what a frame's events say is new
constexpr double kFarthest = 0.1;     // s: for how long a velocity is believed
constexpr double kLongestHole = 0.5;  // s: between two frames, before the pose counts as unknown
// What is known of the motion would hold a false pose as well as a right one: every so many frames the events
// alone have their say.
constexpr int kLookAround = 30;
// The baseline's: frames that do not fit before it says LOST: at rest none does.
constexpr int kFramesOfPatience = 150;

}  // namespace

EventOnlyTracker::EventOnlyTracker(const Rig& rig, const TrackerOptions& options, const SE3& T_map_body)
    : rig_(rig),
      options_(options),
      alignment_(MakeAlignmentSettings(rig, options.window)),
      points_(rig, alignment_, options.points, options.lag_px),
      uncertainty_(rig.camera, options.window),
      start_(options, alignment_, &points_) {
  StartAt(T_map_body, TrackerMode::kBootstrapping, "waiting for the first keyframe");
}

void EventOnlyTracker::Start(const SE3& T_map_body) {
  StartAt(T_map_body, TrackerMode::kBootstrapping, "restarting from a pose hint");
}

void EventOnlyTracker::Start(const BodyState& state) {
  StartAt(state.T_map_body, TrackerMode::kBootstrapping, "continuing from a checkpoint");
  state_ = state;
}

void EventOnlyTracker::Start(Utime t, const BodyState& state, const Matrix15d&) {
  Start(state);
  aligned_at_ = state_time_ = t;
  mode_ = TrackerMode::kTracking;
  reason_ = "resumed from a checkpoint";
  probation_.Skip();
  rivals_.Start(t);
  watched_at_ = t;
}

void EventOnlyTracker::StartAt(const SE3& T_map_body, TrackerMode mode, std::string reason) {
  state_ = BodyState();
  state_.T_map_body = T_map_body;
  rate_.setZero();
  aligned_at_ = 0;
  moving_ = false;
  rejected_ = 0;
  mode_ = mode;
  reason_ = std::move(reason);
  start_.Begin(T_map_body);
}

VisibilityQuery EventOnlyTracker::NextQuery() const {
  SE3 pose = state_.T_map_body;
  pose.p += ToSeconds(PointSelector::kQueryAhead) * state_.velocity;
  return points_.QueryFrom(pose);
}

// The gyro, where there is one, predicts only which part of the map to ask for; no pose depends on it.
VisibilityQuery EventOnlyTracker::QueryAfter(const KeyframeInput& keyframe) const {
  if (keyframe.imu.empty()) return NextQuery();
  const Utime ahead = std::clamp<Utime>(keyframe.t - state_time_, 0, PointSelector::kFarthestAhead);
  const Eigen::Vector3d rate = keyframe.imu.back().gyro - state_.bias.gyro;
  return points_.QueryFrom(PoseAfter(state_, rate, ToSeconds(ahead)));
}

void EventOnlyTracker::AddVisible(const std::vector<std::int32_t>& ids,
                                  const std::vector<Eigen::Vector3f>& points) {
  points_.Add(ids, points, {state_.T_map_body});
}

TrackerOutput EventOnlyTracker::Process(const KeyframeInput& keyframe) {
  TrackerOutput out;
  if (KeepsVelocity() && aligned_at_ > 0 && (!Starting() || keyframe.t < aligned_at_))
    StartAcrossHole(keyframe.t);
  if (Starting() && !moving_) {
    Search(keyframe, &out);
  } else {
    Follow(keyframe, &out);
  }
  state_time_ = keyframe.t;
  out.mode = mode_;
  out.reason = reason_;
  return out;
}

// After this the pose is known no more.
void EventOnlyTracker::StartAcrossHole(Utime t) {
  const double unseen = ToSeconds(t - aligned_at_);
  const char* const why = unseen < 0 ? "the clock went back: restarting (event-only)"
                          : unseen > (rejected_ > 0 ? kFarthest : kLongestHole)
                              ? "no events that fit the map for a while: restarting (event-only)"
                              : nullptr;
  if (why != nullptr) StartAt(state_.T_map_body, TrackerMode::kBootstrapping, why);
}

// The first frame of a start.
void EventOnlyTracker::Search(const KeyframeInput& keyframe, TrackerOutput* out) {
  const SurfaceField field(keyframe.surface, kStartRange.levels);
  const std::optional<LocalizerResult> fit = start_.Search(keyframe, field, out);
  if (!fit) {
    Settle(EventOnlyStart::Status::kUnsure, keyframe.t);
    return;
  }
  state_.T_map_body = fit->T_map_body;
  const AlignmentPoints points = points_.Select(state_, rate_, points_.per_keyframe(), keyframe.seq);
  const Matrix6d alignment = EvaluateAlignmentExactly(alignment_, field, points, fit->T_map_body).hessian;
  motion_.Start(fit->T_map_body, kFrameShare * (alignment + InformationOf(kRange)));
  moving_ = true;
  Accept(keyframe, motion_.state());
  Proves(keyframe, field, points, fit->significance);
}

void EventOnlyTracker::Follow(const KeyframeInput& keyframe, TrackerOutput* out) {
  const double seconds = aligned_at_ > 0 ? ToSeconds(keyframe.t - aligned_at_) : 0;
  MotionFilter motion = motion_;
  const bool moves_on = moving_ && seconds > 0 && seconds <= kFarthest;
  if (moves_on) motion.Predict(seconds);
  BodyState predicted = state_;
  if (moves_on) predicted.T_map_body = motion.state().T_map_body;
  const SurfaceField field(keyframe.surface, Starting() ? kStartRange.levels : kRange.levels);
  const AlignmentPoints points = points_.Select(predicted, rate_, points_.per_keyframe(), keyframe.seq);
  const Matrix6d known = moves_on ? Matrix6d(motion.PoseInformation() / kFrameShare) : InformationOf(kRange);
  LocalizerResult fit = LocalizeBest(alignment_, field, points, predicted.T_map_body, known, kRange.levels);
  const bool misled = moves_on && keyframe.seq % kLookAround == 0 && LooksAround(field, points, &fit);
  out->quality = fit.quality;
  out->iterations = fit.iterations;
  const bool fits =
      IsReachable(fit.T_map_body, seconds) &&
      LiesOnEvents(fit.quality, options_.failure.min_contrast, fit.significance, kFollowSignificance);
  if (!fits) {
    Reject(keyframe.t);
    if (points.size() > 0) Watch(keyframe, fit.significance);
    return;
  }
  const Matrix6d alignment = EvaluateAlignmentExactly(alignment_, field, points, fit.T_map_body).hessian;
  if (moves_on && !misled) {
    // No fit was surer than the prediction: it is not one more observation.
    const bool moved = fit.T_map_body.p != predicted.T_map_body.p;
    motion.Update(fit.T_map_body, (moved ? kFrameShare : 0) * alignment);
  } else if (KeepsVelocity()) {
    motion.Start(fit.T_map_body, kFrameShare * (alignment + InformationOf(kRange)));
  }
  motion_ = motion;
  moving_ = KeepsVelocity();
  Accept(keyframe, moving_ ? motion.state() : MotionTo(fit.T_map_body, seconds));
  out->image_speed = MedianImageSpeed(alignment_, points, state_.T_map_body, state_.velocity, rate_);
  if (Proves(keyframe, field, points, fit.significance) && Watch(keyframe, fit.significance))
    Report(keyframe, field, points, fit, alignment, out);
}

void EventOnlyTracker::Report(const KeyframeInput& keyframe, const SurfaceField& field,
                              const AlignmentPoints& points, const LocalizerResult& fit,
                              const Matrix6d& alignment, TrackerOutput* out) {
  out->information.topLeftCorner<6, 6>() = alignment;
  out->information.bottomRightCorner<9, 9>().setIdentity();
  uncertainty_.SetAlignment(alignment, MeasureMisfit(alignment_, field, points, fit.T_map_body));
  out->covariance = uncertainty_.Covariance(PoseCovariance(out->information), state_.velocity, rate_) +
                    ExtrinsicsCovariance(state_.T_map_body, rig_);
  out->nodes.push_back({keyframe.t, keyframe.seq, state_});
  out->has_pose = true;
}

// Whether the events alone say that the pose is another; `fit` is that then.
bool EventOnlyTracker::LooksAround(const SurfaceField& field, const AlignmentPoints& points,
                                   LocalizerResult* fit) const {
  const LocalizerResult wide = LocalizeBest(alignment_, field, points, fit->T_map_body, kRange);
  if (SignificanceOver(alignment_, field, points, wide.T_map_body, fit->T_map_body) < kTrackingSignificance)
    return false;
  *fit = wide;
  return true;
}

// A frame may fit elsewhere by chance, where nothing can get to in that time. At the start, or where the
// clock went back, it is not known so well where the body is.
bool EventOnlyTracker::IsReachable(const SE3& T_map_body, double seconds) const {
  return seconds <= 0 ||
         (T_map_body.p - state_.T_map_body.p).norm() <= kFrameError + options_.failure.max_speed * seconds;
}

// As the newest two poses have it.
MotionFilter::State EventOnlyTracker::MotionTo(const SE3& T_map_body, double seconds) const {
  const SE3& previous = state_.T_map_body;
  if (seconds <= 0) return {T_map_body, state_.velocity, rate_};
  return {T_map_body, (T_map_body.p - previous.p) / seconds,
          LogSO3(previous.q.conjugate() * T_map_body.q) / seconds};
}

void EventOnlyTracker::Accept(const KeyframeInput& keyframe, const MotionFilter::State& state) {
  state_.T_map_body = state.T_map_body;
  state_.velocity = state.velocity;
  rate_ = state.rate;
  aligned_at_ = keyframe.t;
  rejected_ = 0;
  if (KeepsVelocity() && mode_ != TrackerMode::kTracking) return;
  mode_ = TrackerMode::kTracking;
  reason_ = "tracking (event-only)";
}

// Whether the frame's pose is worth reporting: while tracking each is, at the start once it is found.
bool EventOnlyTracker::Proves(const KeyframeInput& keyframe, const SurfaceField& field,
                              const AlignmentPoints& points, double significance) {
  if (!Starting()) return true;
  const EventOnlyStart::Status status =
      start_.Follow(keyframe, field, points, state_.T_map_body, significance);
  Settle(status, keyframe.t);
  return status == EventOnlyStart::Status::kFound || status == EventOnlyStart::Status::kProven;
}

// What the start makes of the mode. LOST, and the reason for it, stay until the map is found again.
void EventOnlyTracker::Settle(EventOnlyStart::Status status, Utime t) {
  if (status == EventOnlyStart::Status::kProven) {
    mode_ = TrackerMode::kTracking;
    reason_ = "tracking (event-only)";
    probation_.Begin(t);
    rivals_.Start(t);
    watched_at_ = t;
    return;
  }
  if (status == EventOnlyStart::Status::kElsewhere) {
    state_ = BodyState();
    state_.T_map_body = start_.pose();
    rate_.setZero();
    moving_ = false;
  }
  if (mode_ == TrackerMode::kLost && status != EventOnlyStart::Status::kFound) return;
  mode_ = start_.hopeless() ? TrackerMode::kLost : TrackerMode::kBootstrapping;
  reason_ = start_.reason();
}

// Whether it may still be TRACKING where it says: a start that looked right may be a false one, and another
// pose may explain the events better.
bool EventOnlyTracker::Watch(const KeyframeInput& keyframe, double significance) {
  if (!KeepsVelocity() || Starting() || keyframe.t - watched_at_ < EventOnlyStart::kApart) return true;
  watched_at_ = keyframe.t;
  probation_.Add(significance);
  const std::string wrong = probation_.WhyFalse(keyframe.t);
  if (!wrong.empty()) {
    StartAt(state_.T_map_body, TrackerMode::kLost, wrong);
    return false;
  }
  if (keyframe.n_events < options_.min_events) return true;
  const std::optional<SE3> rival =
      rivals_.Search(alignment_, points_, keyframe, state_, rate_, /*coasting=*/rejected_ > 0);
  if (!rival) return true;
  StartAt(*rival, TrackerMode::kLost, "another pose explains the events better");
  return false;
}

void EventOnlyTracker::Reject(Utime t) {
  if (Starting()) {
    Settle(start_.FollowNothing(t), t);
    return;
  }
  if (++rejected_ <= kFramesOfPatience) return;
  state_.velocity.setZero();
  rate_.setZero();
  mode_ = TrackerMode::kLost;
  reason_ = "the map does not lie on the events (event-only)";
}

}  // namespace evit
