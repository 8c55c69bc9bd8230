// The tracker at work: one keyframe more in the window, or, where its events say nothing, coasting on the
// IMU.
#include <cmath>
#include <utility>

#include "common/tracking/pose_covariance.h"
#include "common/tracking/text.h"
#include "common/tracking/tracker.h"

namespace evit {

void Tracker::ProcessTracking(const KeyframeInput& keyframe, TrackerOutput* out) {
  WindowNode node;
  node.t = keyframe.t;
  node.seq = keyframe.seq;
  node.state = Predict(keyframe);
  node.field = std::make_shared<SurfaceField>(keyframe.surface, 1);
  const bool eventful = keyframe.n_events >= options_.min_events;
  if (eventful) {
    node.points =
        SamplePoints(node.state, static_cast<int>(point_share_ * options_.points.per_keyframe), keyframe.seq);
  }
  const std::size_t n_points = node.points.size();
  node.imu = std::make_shared<Preintegration>(keyframe.imu, state_.bias, rig_.imu_noise);
  window_.Push(std::move(node));
  std::vector<BodyState> before;
  for (const WindowNode& n : window_.nodes()) before.push_back(n.state);
  const SlidingWindow::Summary summary = window_.Solve();
  out->iterations = summary.iterations;
  out->quality = MeasureAlignment(alignment_, *window_.nodes().back().field, window_.nodes().back().points,
                                  window_.nodes().back().state.T_map_body);
  // A surface that the map does not lie on would only pull the pose away: the IMU knows better for a while.
  std::string coasting;
  if (!eventful) {
    coasting = "no events";
  } else if (n_points < kMinPoints) {
    coasting = "no map points in view";
  } else if (!Aligned(out->quality, options_.failure.min_contrast)) {
    coasting = "the map does not lie on the events";
  }
  if (!coasting.empty()) window_.DropNewestAlignment(before);
  const WindowNode& newest = window_.nodes().back();
  state_ = newest.state;
  out->information = window_.NewestInformation();
  if (coasting.empty()) {
    common_ = CommonCovariance(newest.alignment.hessian, options_.window.correlated_share,
                               options_.window.map_sigma_m);
  }
  out->covariance = PoseCovariance(out->information) + common_ +
                    StampCovariance(state_.velocity, rate_, 1e-6 * options_.window.stamp_sigma_us);

  const std::string trouble = Trouble(keyframe, summary.usable, coasting, *out);
  if (!trouble.empty()) {
    const bool sane = state_.velocity.norm() <= options_.failure.max_speed &&
                      state_.bias.gyro.norm() <= options_.failure.max_gyro_bias &&
                      state_.bias.accel.norm() <= options_.failure.max_accel_bias;
    if (!sane) state_.bias = {};
    // Where it has diverged, the prediction from the state before is the better place to look.
    Restart(sane ? state_.T_map_body : before.back().T_map_body,
            sane ? state_.velocity : Eigen::Vector3d::Zero(), "");
    SetMode(TrackerMode::kLost, trouble);
    return;
  }
  reason_ = coasting.empty() ? "tracking" : "coasting on the IMU: " + coasting;
  if (!coasting.empty()) out->quality = {};
  for (const WindowNode& n : window_.nodes()) out->nodes.push_back({n.t, n.seq, n.state});
  Finish(coasting.empty() ? newest.points : AlignmentPoints(), out);
}

// Why tracking cannot go on; empty where it can.
std::string Tracker::Trouble(const KeyframeInput& keyframe, bool usable, const std::string& coasting,
                             const TrackerOutput& out) {
  const FailureOptions& limits = options_.failure;
  if (!usable) return "the solver failed";
  if (state_.velocity.norm() > limits.max_speed) {
    return Text("speed of %.1f m/s is over the limit of %.1f", state_.velocity.norm(), limits.max_speed);
  }
  if (state_.bias.gyro.norm() > limits.max_gyro_bias || state_.bias.accel.norm() > limits.max_accel_bias) {
    return Text("biases too large: gyro %.3f rad/s, accel %.2f m/s^2", state_.bias.gyro.norm(),
                state_.bias.accel.norm());
  }
  if (coasting.empty()) {
    aligned_at_ = keyframe.t;
    return "";
  }
  const double coasted = ToSeconds(keyframe.t - aligned_at_);
  const double sigma = std::sqrt(out.covariance.topLeftCorner<3, 3>().diagonal().maxCoeff());
  if (coasted <= limits.max_coast_s && sigma <= limits.max_position_sigma_m) return "";
  return coasting + Text(" for %.1f s, position known to %.2f m", coasted, sigma);
}

}  // namespace evit
