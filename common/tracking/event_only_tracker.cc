#include "common/tracking/event_only_tracker.h"

#include <algorithm>

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
constexpr double kFrameShare = 0.1;  // of what a frame's events say is new
constexpr double kFarthest = 0.1;    // s: for how long a velocity is believed
// What is known of the motion would hold a false pose as well as a right one: every so many frames the events
// alone have their say.
constexpr int kLookAround = 30;
constexpr int kPatience = 150;  // frames that do not fit before it says LOST: at rest none does

}  // namespace

EventOnlyTracker::EventOnlyTracker(const Rig& rig, const TrackerOptions& options, const SE3& T_map_body)
    : rig_(rig),
      options_(options),
      alignment_(MakeAlignmentSettings(rig, options.window)),
      points_(rig, alignment_, options.points, options.lag_px),
      uncertainty_(rig.camera, options.window) {
  state_.T_map_body = T_map_body;
}

void EventOnlyTracker::Start(const SE3& T_map_body) {
  BodyState start;
  start.T_map_body = T_map_body;
  Start(start);
  reason_ = "restarting from a pose hint";
}

void EventOnlyTracker::Start(const BodyState& state) {
  state_ = state;
  rate_.setZero();
  aligned_at_ = 0;
  moving_ = false;
  rejected_ = 0;
  mode_ = TrackerMode::kBootstrapping;
  reason_ = "continuing from a checkpoint";
}

void EventOnlyTracker::Start(Utime t, const BodyState& state, const Matrix15d&) {
  Start(state);
  aligned_at_ = state_time_ = t;
  mode_ = TrackerMode::kTracking;
  reason_ = "resumed from a checkpoint";
}

VisibilityQuery EventOnlyTracker::NextQuery() const {
  SE3 pose = state_.T_map_body;
  pose.p += ToSeconds(PointSelector::kQueryAhead) * state_.velocity;
  return points_.QueryFrom(pose);
}

// The gyro predicts only which part of the map to ask for; no pose depends on it.
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
  const double seconds = aligned_at_ > 0 ? ToSeconds(keyframe.t - aligned_at_) : 0;
  MotionFilter motion = motion_;
  const bool moves_on = moving_ && seconds > 0 && seconds <= kFarthest;
  if (moves_on) motion.Predict(seconds);
  BodyState predicted = state_;
  if (moves_on) predicted.T_map_body = motion.state().T_map_body;
  const SurfaceField field(keyframe.surface, kRange.levels);
  const AlignmentPoints points = points_.Select(predicted, rate_, points_.per_keyframe(), keyframe.seq);
  const Matrix6d known = moves_on ? Matrix6d(motion.PoseInformation() / kFrameShare) : InformationOf(kRange);
  LocalizerResult fit = LocalizeBest(alignment_, field, points, predicted.T_map_body, known, kRange.levels);
  const bool misled = moves_on && keyframe.seq % kLookAround == 0 && LooksAround(field, points, &fit);
  state_time_ = keyframe.t;
  TrackerOutput out;
  out.quality = fit.quality;
  out.iterations = fit.iterations;
  if (IsReachable(fit.T_map_body, seconds) &&
      LiesOnEvents(fit.quality, options_.failure.min_contrast, fit.significance, kFollowSignificance)) {
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
    out.information.topLeftCorner<6, 6>() = alignment;
    out.information.bottomRightCorner<9, 9>().setIdentity();
    uncertainty_.SetAlignment(alignment, MeasureMisfit(alignment_, field, points, fit.T_map_body));
    out.covariance = uncertainty_.Covariance(PoseCovariance(out.information), state_.velocity, rate_) +
                     ExtrinsicsCovariance(state_.T_map_body, rig_);
    out.nodes.push_back({keyframe.t, keyframe.seq, state_});
    out.has_pose = true;
    out.image_speed = MedianImageSpeed(alignment_, points, state_.T_map_body, state_.velocity, rate_);
  } else {
    Reject();
  }
  out.mode = mode_;
  out.reason = reason_;
  return out;
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
  mode_ = TrackerMode::kTracking;
  reason_ = "tracking (event-only)";
}

void EventOnlyTracker::Reject() {
  if (++rejected_ <= kPatience) return;
  state_.velocity.setZero();
  rate_.setZero();
  mode_ = TrackerMode::kLost;
  reason_ = "the map does not lie on the events (event-only)";
}

}  // namespace evit
