#include "common/photometric/photometric_tracker.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "common/text/format_text.h"
#include "common/tracking/pose_covariance.h"

namespace evit {
namespace {

constexpr Utime kQueryAhead = 20'000;     // us: for the first view
constexpr Utime kLongestGuess = 200'000;  // us at constant velocity: beyond that the last pose is as good
constexpr int kMinPoints = 100;           // fewer say nothing about twelve unknowns
constexpr double kMostLag = 0.5;          // of a frame's interval

}  // namespace

PhotometricTracker::PhotometricTracker(const Rig& rig, const PhotometricTrackerOptions& options,
                                       const SE3& T_map_body)
    : rig_(rig), options_(options), solver_(rig, options.photometric) {
  state_.T_map_body = T_map_body;
}

void PhotometricTracker::Start(const SE3& T_map_body) {
  state_ = BodyState();
  state_.T_map_body = T_map_body;
  rate_.setZero();
  image_speed_ = 0;
  state_time_ = last_interval_ = 0;
  mode_ = TrackerMode::kBootstrapping;
  reason_ = "restarting from a pose hint";
}

SE3 PhotometricTracker::PoseAfter(const SE3& pose, double seconds) const {
  return {(ExpSO3(seconds * rate_) * pose.q).normalized(), pose.p + seconds * state_.velocity};
}

ViewQuery PhotometricTracker::NextQuery() const {
  ViewQuery query;
  const Utime ahead = std::min(last_interval_ > 0 ? last_interval_ : kQueryAhead, kLongestGuess);
  query.T_map_camera = PoseAfter(state_.T_map_body, ToSeconds(ahead)) * rig_.T_body_camera;
  query.camera = ViewCamera(rig_.camera, options_.photometric.view_margin);
  query.min_depth = options_.min_depth_m;
  query.max_depth = options_.max_depth_m;
  return query;
}

TrackerOutput PhotometricTracker::Process(const PhotometricFrame& frame) {
  TrackerOutput out;
  if (state_time_ != 0 && (frame.t <= state_time_ || frame.t - state_time_ > kLongestGuess)) {
    state_.velocity.setZero();  // the clock went back, or frames are missing: only the last pose is known
    rate_.setZero();
  }
  const double dt = state_time_ != 0 ? std::max(0.0, ToSeconds(frame.t - state_time_)) : 0;
  const SE3 predicted = PoseAfter(state_.T_map_body, dt);
  const double seconds = ToSeconds(frame.end - frame.begin);
  if (frame.n_events < options_.min_events || !(seconds > 0)) {
    Coast(frame, predicted, "too few events", &out);
  } else {
    // Events tell of their interval's middle, and are late by the way an edge goes before a pixel fires.
    const double lag = image_speed_ > 0 ? std::min(options_.lag_px / image_speed_, kMostLag * seconds) : 0;
    const double after_events = ToSeconds(frame.t - frame.begin) - 0.5 * seconds + lag;
    Twist motion;
    motion << state_.velocity, rate_;
    const PhotometricSolution solution =
        solver_.Solve(frame, view_, PoseAfter(predicted, -after_events), motion);
    out.iterations = solution.iterations;
    out.quality.n_points = solution.quality.n_points;
    out.quality.inlier_share = std::clamp(solution.quality.correlation, 0.0, 1.0);
    if (solution.quality.n_points < kMinPoints) {
      Coast(frame, predicted, "nothing of the map in view has a gradient", &out);
    } else if (solution.quality.correlation < options_.photometric.min_correlation) {
      Coast(
          frame, predicted,
          FormatText("the map does not predict the events (correlation %.2f)", solution.quality.correlation),
          &out);
    } else {
      Accept(frame, after_events, solution, &out);
    }
  }
  last_interval_ = state_time_ != 0 ? std::max<Utime>(0, frame.t - state_time_) : 0;
  state_time_ = frame.t;
  out.mode = mode_;
  out.reason = reason_;
  return out;
}

void PhotometricTracker::Accept(const PhotometricFrame& frame, double after_events,
                                const PhotometricSolution& solution, TrackerOutput* out) {
  state_.velocity = solution.twist.head<3>() +
                    Eigen::Vector3d(solution.twist.tail<3>()).cross(solution.pose.p - solution.origin);
  rate_ = solution.twist.tail<3>();
  state_.T_map_body = PoseAfter(solution.pose, after_events);
  image_speed_ = solution.image_speed;
  good_time_ = frame.t;
  mode_ = TrackerMode::kTracking;
  reason_ = "tracking (photometric)";
  out->has_pose = true;
  out->image_speed = image_speed_;
  out->information.topLeftCorner<6, 6>() = solution.information;
  out->information.bottomRightCorner<9, 9>().setIdentity();
  // Without a correlated share: the weight of a point knows already that neighbours err together.
  covariance_ = PoseCovariance(out->information) +
                SystematicCovariance(solution.information, 0, options_.map_sigma_m) +
                TimeOffsetCovariance(state_.velocity, state_.T_map_body.q.conjugate() * rate_,
                                     1e-6 * options_.stamp_sigma_us);
  out->covariance = covariance_ + ExtrinsicsCovariance(state_.T_map_body, rig_);
  out->nodes.push_back({frame.t, frame.seq, state_});
}

void PhotometricTracker::Coast(const PhotometricFrame& frame, const SE3& predicted, const std::string& why,
                               TrackerOutput* out) {
  if (mode_ == TrackerMode::kBootstrapping) {
    reason_ = "waiting for events that fit the map: " + why;
    return;
  }
  const double bad = ToSeconds(frame.t - good_time_);
  if (mode_ == TrackerMode::kLost || bad > options_.photometric.max_bad_s) {
    if (mode_ != TrackerMode::kLost) reason_ = why + FormatText(" for %.1f s", bad);
    mode_ = TrackerMode::kLost;
    state_.velocity.setZero();
    rate_.setZero();
    image_speed_ = 0;
    return;
  }
  state_.T_map_body = predicted;
  reason_ = "coasting at constant velocity: " + why;
  out->has_pose = true;
  out->image_speed = image_speed_;
  // Since the last good frame the velocity may have changed by as much as a frame is allowed to change it.
  Vector6d unknown;
  unknown << Eigen::Vector3d::Constant(bad * options_.photometric.sigma_velocity),
      Eigen::Vector3d::Constant(bad * options_.photometric.sigma_rate);
  const Matrix6d by_map = covariance_ + Matrix6d(unknown.cwiseAbs2().asDiagonal());
  out->covariance = by_map + ExtrinsicsCovariance(state_.T_map_body, rig_);
  out->information.setIdentity();
  out->information.topLeftCorner<6, 6>() = by_map.inverse();
  out->nodes.push_back({frame.t, frame.seq, state_});
}

}  // namespace evit
