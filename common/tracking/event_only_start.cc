#include "common/tracking/event_only_start.h"

#include "common/tracking/alignment_significance.h"
#include "common/tracking/gates.h"
#include "common/tracking/place_search.h"

namespace evit {
namespace {

constexpr int kPatienceOfStart = 100;  // frames that do not fit before the start counts as failed: a second

}  // namespace

void EventOnlyStart::Begin(const SE3& T_map_body) {
  BodyState start;
  start.T_map_body = T_map_body;
  chain_.Start(start);
  status_ = Status::kUnsure;
  looked_at_ = 0;
  rejected_ = 0;
}

std::optional<LocalizerResult> EventOnlyStart::Search(const KeyframeInput& keyframe,
                                                      const SurfaceField& field, TrackerOutput* out) {
  if (looked_at_ > 0 && keyframe.t >= looked_at_ && keyframe.t - looked_at_ < kApart) return std::nullopt;
  looked_at_ = keyframe.t;
  chain_.Begin(keyframe.t);
  const Eigen::Vector3d at_rest = Eigen::Vector3d::Zero();
  BodyState predicted;
  predicted.T_map_body = pose();
  predicted.T_map_body =
      InitialPose(alignment_, *points_, field, predicted, at_rest, rejected_, keyframe.seq);
  const AlignmentPoints points = points_->Select(predicted, at_rest, points_->per_keyframe(), keyframe.seq);
  sees_map_ = points.size() >= kMinPoints;
  const LocalizerResult fit =
      SearchStart(alignment_, field, points, predicted.T_map_body, kStartRange, keyframe.seq);
  out->quality = fit.quality;
  out->iterations = fit.iterations;
  if (!WithinReach(fit.T_map_body, predicted.T_map_body, kStartRange) ||
      !LiesOnEvents(fit.quality, options_.bootstrap.min_contrast, fit.significance, kStartSignificance)) {
    Reject();
    return std::nullopt;
  }
  looked_at_ = 0;  // it counts as the first of a chain
  return fit;
}

EventOnlyStart::Status EventOnlyStart::Follow(const KeyframeInput& keyframe, const SurfaceField& field,
                                              const AlignmentPoints& points, const SE3& T_map_body,
                                              double significance) {
  fitted_at_ = keyframe.t;
  n_events_ += keyframe.n_events;
  if (looked_at_ > 0 && keyframe.t - looked_at_ < kApart) return status_;
  looked_at_ = keyframe.t;
  chain_.Add({{keyframe.t, T_map_body, nullptr}, n_counted_++, significance, n_events_, nullptr, {}});
  n_events_ = 0;
  if (chain_.RecentVelocity().norm() > options_.failure.max_speed) {
    Reject();
    return status_;
  }
  switch (chain_.Judge(field, points)) {
    case StartChain::Verdict::kUnsure:
      status_ = Status::kUnsure;
      break;
    case StartChain::Verdict::kFalse:
      Reject();
      break;
    case StartChain::Verdict::kElsewhere:
      status_ = Status::kElsewhere;
      rejected_ = 0;
      break;
    case StartChain::Verdict::kFound:
    case StartChain::Verdict::kDoubted:
      status_ = Status::kFound;
      rejected_ = 0;
      break;
    case StartChain::Verdict::kProven:
      status_ = Status::kProven;
      rejected_ = 0;
      break;
  }
  return status_;
}

EventOnlyStart::Status EventOnlyStart::FollowNothing(Utime t) {
  if (t < fitted_at_ || t - fitted_at_ >= kApart) Reject();
  return status_;
}

void EventOnlyStart::Reject() {
  n_events_ = 0;
  chain_.Break();
  ++rejected_;
  status_ = Status::kElsewhere;
}

bool EventOnlyStart::hopeless() const { return rejected_ > kPatienceOfStart; }

std::string EventOnlyStart::reason() const {
  if (status_ == Status::kFound) return "localising frames (event-only)";
  if (!hopeless()) return "waiting for events that fit the map (event-only)";
  return sees_map_ ? "the map does not lie on the events around the start pose (event-only)"
                   : "no map points in view of the start pose: is the map in metres, and the start pose in "
                     "its frame?";
}

}  // namespace evit
