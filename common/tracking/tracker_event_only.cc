// EVT, the paper's event-only baseline (Sec. IV): each frame is localised by its events alone, from the
// previous pose. Nothing of the IMU is used.
#include <cmath>
#include <utility>

#include "common/tracking/pose_covariance.h"
#include "common/tracking/text.h"
#include "common/tracking/tracker.h"

namespace evit {
namespace {

constexpr int kLevels = 3;
constexpr StartSigma kStart{0.05, 0.05};  // how far a body may get between two frames, and then some
constexpr int kPatience = 30;             // frames that do not fit before it says LOST

}  // namespace

void Tracker::ProcessEventOnly(const KeyframeInput& keyframe, TrackerOutput* out) {
  // Since the newest frame that fitted: the state is that one's.
  const double dt = aligned_at_ > 0 ? ToSeconds(keyframe.t - aligned_at_) : 0;
  const SE3 previous = state_.T_map_body;
  BodyState predicted = state_;
  if (options_.window.motion_model != WindowOptions::MotionModel::kPreviousPose &&
      dt > 0) {  // constant velocity
    predicted.T_map_body.p += dt * state_.velocity;
    predicted.T_map_body.q = (previous.q * ExpSO3(dt * rate_)).normalized();
  }
  const SurfaceField field(keyframe.surface, kLevels);
  const AlignmentPoints points = SamplePoints(predicted, options_.points.per_keyframe, keyframe.seq);
  const LocalizerResult fit = Localize(alignment_, field, points, predicted.T_map_body, kStart, kLevels);
  out->quality = fit.quality;
  out->iterations = fit.iterations;
  const bool good = Aligned(fit.quality, options_.failure.min_contrast);
  bad_frames_ = good ? 0 : bad_frames_ + 1;
  state_time_ = keyframe.t;
  if (bad_frames_ > kPatience) {
    state_.velocity.setZero();
    rate_.setZero();
    SetMode(TrackerMode::kLost, "the map does not lie on the events (event-only)");
  } else if (good) {
    if (dt > 0) {
      state_.velocity = (fit.T_map_body.p - previous.p) / dt;
      rate_ = LogSO3(previous.q.conjugate() * fit.T_map_body.q) / dt;
    }
    state_.T_map_body = fit.T_map_body;
    aligned_at_ = keyframe.t;
    SetMode(TrackerMode::kTracking, "tracking (event-only)");
    const Matrix6d alignment = EvaluateAlignment(alignment_, field, 0, points, fit.T_map_body, true).hessian;
    out->information.topLeftCorner<6, 6>() = alignment;
    out->information.bottomRightCorner<9, 9>().setIdentity();
    out->covariance =
        PoseCovariance(out->information) +
        CommonCovariance(alignment, options_.window.correlated_share, options_.window.map_sigma_m) +
        StampCovariance(state_.velocity, rate_, 1e-6 * options_.window.stamp_sigma_us);
    out->nodes.push_back({keyframe.t, keyframe.seq, state_});
    Finish(points, out);
  }
  out->mode = mode_;
  out->reason = reason_;
}

}  // namespace evit
