#include "common/tracking/tracker.h"

#include <algorithm>
#include <utility>

#include "common/text/format_text.h"
#include "common/tracking/image_speed.h"
#include "common/tracking/keyframe_need.h"
#include "common/tracking/pose_covariance.h"

namespace evit {
namespace {

constexpr Utime kLongestGuess = 500'000;  // us at constant velocity: beyond that the last pose is as good

}  // namespace

Tracker::Tracker(const Rig& rig, const TrackerOptions& options, const SE3& T_map_body)
    : limits_(options.failure),
      alignment_(MakeAlignmentSettings(rig, options.window)),
      points_(rig, alignment_, options.points, options.lag_px),
      bootstrapper_(rig, options, alignment_, &points_),
      window_(rig, options, alignment_, &points_) {
  BodyState start;
  start.T_map_body = T_map_body;
  bootstrapper_.Start(start);
}

const BodyState& Tracker::state() const {
  return mode_ == TrackerMode::kTracking ? window_.state() : bootstrapper_.state();
}

void Tracker::Start(const SE3& T_map_body) {
  BodyState start;
  start.T_map_body = T_map_body;
  start.bias = state().bias;
  StartBootstrapping(start, TrackerMode::kBootstrapping, "restarting from a pose hint");
}

void Tracker::Start(const BodyState& state) {
  state_time_ = 0;  // whatever was before: the next keyframe does not follow it
  StartBootstrapping(state, TrackerMode::kBootstrapping, "continuing from a checkpoint");
}

void Tracker::Start(Utime t, const BodyState& state, const Matrix15d& information) {
  window_.Start(t, state, information);
  state_time_ = t;
  SetMode(TrackerMode::kTracking, "resumed from a checkpoint");
}

void Tracker::StartBootstrapping(const BodyState& state, TrackerMode mode, std::string reason) {
  bootstrapper_.Start(state);
  SetMode(mode, std::move(reason));
}

void Tracker::SetMode(TrackerMode mode, std::string reason) {
  mode_ = mode;
  reason_ = std::move(reason);
}

VisibilityQuery Tracker::NextQuery() const {
  SE3 pose = state().T_map_body;
  pose.p += ToSeconds(last_interval_ > 0 ? last_interval_ : PointSelector::kQueryAhead) * state().velocity;
  return points_.QueryFrom(pose);
}

VisibilityQuery Tracker::QueryAfter(const KeyframeInput& keyframe) const { return QueryAfter(keyframe, 0); }

// The points of a query serve all views within some distance of it. This one lies half of that distance ahead
// of the next view, so that its points last longer; the other half is a reserve against another motion.
VisibilityQuery Tracker::QueryBeyond(const KeyframeInput& keyframe) const {
  constexpr double kLongest = 0.1;  // s: farther, a prediction is a guess
  VisibilityQuery next = QueryAfter(keyframe);
  if (mode_ != TrackerMode::kTracking || !(image_speed_ > 0)) return next;
  const VisibilityQuery beyond =
      QueryAfter(keyframe, std::min(PointSelector::kLeadShare * next.margin_px / image_speed_, kLongest));
  return points_.Suffice(beyond, next) ? beyond : next;
}

// `further`: s, beyond the next keyframe.
VisibilityQuery Tracker::QueryAfter(const KeyframeInput& keyframe, double further) const {
  if (mode_ != TrackerMode::kTracking || keyframe.imu.empty()) return NextQuery();
  const Utime ahead = std::clamp<Utime>(keyframe.t - state_time_, 0, PointSelector::kFarthestAhead);
  const Eigen::Vector3d rate = keyframe.imu.back().gyro - state().bias.gyro;
  return points_.QueryFrom(PoseAfter(window_.Predict(keyframe), rate, ToSeconds(ahead) + further));
}

void Tracker::AddVisible(const std::vector<std::int32_t>& ids, const std::vector<Eigen::Vector3f>& points) {
  std::vector<SE3> poses{state().T_map_body};
  if (mode_ == TrackerMode::kTracking) {
    for (const WindowNode& node : window_.nodes()) poses.push_back(node.state.T_map_body);
  }
  points_.Add(ids, points, poses);
}

TrackerOutput Tracker::Process(const KeyframeInput& keyframe) {
  TrackerOutput out;
  if (!keyframe.imu.empty()) rate_ = keyframe.imu.back().gyro - state().bias.gyro;
  const bool first = state_time_ == 0, follows = !first && Follows(keyframe);
  if (!first && !follows) StartAcrossGap(keyframe);
  if (mode_ == TrackerMode::kTracking) {
    Track(keyframe, &out);
  } else {
    Bootstrap(keyframe, follows, &out);
  }
  last_interval_ = first ? 0 : keyframe.t - state_time_;
  state_time_ = keyframe.t;
  out.mode = mode_;
  out.reason = reason_;
  return out;
}

// Whether the keyframe's IMU samples tell how the body came here from the keyframe before.
bool Tracker::Follows(const KeyframeInput& keyframe) const {
  return ImuReaches(keyframe) && ImuGapMs(keyframe) <= limits_.max_imu_gap_ms;
}

bool Tracker::ImuReaches(const KeyframeInput& keyframe) const {
  return keyframe.imu.size() >= 2 && keyframe.imu.front().t == state_time_ &&
         keyframe.imu.back().t == keyframe.t;
}

double Tracker::ImuGapMs(const KeyframeInput& keyframe) const {
  return 1e-3 * static_cast<double>(ImuReaches(keyframe) ? keyframe.imu_gap : keyframe.t - state_time_);
}

void Tracker::StartAcrossGap(const KeyframeInput& keyframe) {
  const double gap_ms = ImuGapMs(keyframe);
  BodyState start = state();
  if (keyframe.t <= state_time_) {
    start.velocity.setZero();
    const double back_ms = 1e-3 * static_cast<double>(state_time_ - keyframe.t);
    StartBootstrapping(
        start, TrackerMode::kBootstrapping,
        back_ms > 0 ? FormatText("the clock went back by %.1f ms: restarting from the last pose", back_ms)
                    : "two keyframes have the same time: restarting from the last pose");
    return;
  }
  const Utime unseen = keyframe.t - state_time_;
  if (mode_ == TrackerMode::kTracking && unseen <= kLongestGuess) {
    start.T_map_body = PoseAfter(start, rate_, ToSeconds(unseen));
  } else {
    start.velocity.setZero();
  }
  StartBootstrapping(start, TrackerMode::kBootstrapping,
                     FormatText("IMU gap of %.0f ms: restarting from the predicted pose", gap_ms));
}

void Tracker::Bootstrap(const KeyframeInput& keyframe, bool follows, TrackerOutput* out) {
  Bootstrapper::Result found = bootstrapper_.Process(keyframe, follows, rate_);
  out->quality = found.quality;
  out->iterations = found.iterations;
  // How the next surfaces are drawn: by the gyro's part of the image speed, until the velocity is known too.
  out->image_speed = MedianImageSpeed(alignment_, found.points, state().T_map_body, state().velocity, rate_);
  const bool lost = mode_ == TrackerMode::kLost;  // and the reason for it stays until the map is found again
  switch (found.status) {
    case Bootstrapper::Result::Status::kRejected:
      if (!lost) SetMode(TrackerMode::kBootstrapping, found.reason);
      return;
    case Bootstrapper::Result::Status::kHopeless:
      if (!lost) SetMode(TrackerMode::kLost, found.reason);
      return;
    case Bootstrapper::Result::Status::kUnsure:
      return;
    case Bootstrapper::Result::Status::kLocalized:
      SetMode(TrackerMode::kBootstrapping, found.reason);
      out->nodes.push_back({keyframe.t, keyframe.seq, state()});
      break;
    case Bootstrapper::Result::Status::kAligned:
      window_.Start(std::move(found.window), found.prior);
      SetMode(TrackerMode::kTracking, "bootstrapped");
      ReportWindow(out);
      window_.ReportUncertainty(rate_, out);
      break;
  }
  ReportPose(found.points, out);
}

void Tracker::Track(const KeyframeInput& keyframe, TrackerOutput* out) {
  const WindowTracker::Result result = window_.Process(keyframe, rate_, out);
  if (!result.failure.empty()) {
    StartBootstrapping(result.restart, TrackerMode::kLost, result.failure);
    return;
  }
  ReportWindow(out);
  if (result.coasting.empty()) {
    SetMode(TrackerMode::kTracking, "tracking");
    ReportPose(window_.nodes().back().points, out);
    out->useful_interval =
        UsefulInterval({PoseCovariance(out->information), window_.SystematicUncertainty(rate_),
                        window_.MeanInterval(), out->image_speed, alignment_.camera().width});
  } else {
    SetMode(TrackerMode::kTracking,
            result.stands_still ? "standing still" : "coasting on the IMU: " + result.coasting);
    out->quality = {};
    ReportPose({}, out);
  }
}

void Tracker::ReportWindow(TrackerOutput* out) const {
  for (const WindowNode& n : window_.nodes()) out->nodes.push_back({n.t, n.seq, n.state});
}

void Tracker::ReportPose(const AlignmentPoints& points, TrackerOutput* out) {
  out->has_pose = true;
  out->image_speed = image_speed_ =
      MedianImageSpeed(alignment_, points, state().T_map_body, state().velocity, rate_);
}

}  // namespace evit
