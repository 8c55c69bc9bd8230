#include "common/tracking/window_tracker.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "common/imu/propagation.h"
#include "common/text/format_text.h"
#include "common/tracking/alignment_significance.h"
#include "common/tracking/gates.h"

namespace evit {
namespace {

constexpr Utime kLongCoasting = 500'000;  // us

double PositionSigma(const Matrix6d& covariance) {
  return std::sqrt(covariance.topLeftCorner<3, 3>().diagonal().maxCoeff());
}

}  // namespace

WindowTracker::WindowTracker(const Rig& rig, const TrackerOptions& options,
                             const AlignmentSettings& alignment, const PointSelector* points)
    : rig_(rig),
      options_(options),
      alignment_(alignment),
      points_(points),
      window_(alignment, rig.gravity, options.window),
      uncertainty_(rig.camera, options.window),
      steadiness_(rig.imu_noise) {}

void WindowTracker::Start(std::deque<WindowNode> nodes, const StatePrior& prior) {
  window_.Start(std::move(nodes), prior);
  window_.Solve();
  const Utime t = window_.nodes().back().t;
  ForgetMotion();
  probation_.Begin(t);
  rivals_.Start(t);
  SetUncertainty(window_.nodes().back());
}

void WindowTracker::ForgetMotion() {
  coasted_ = 0;
  steadiness_ = Steadiness(rig_.imu_noise);
  started_gently_ = false;
}

void WindowTracker::SetUncertainty(const WindowNode& newest) {
  uncertainty_.SetAlignment(newest.alignment.hessian,
                            MeasureMisfit(alignment_, *newest.field, newest.points, newest.state.T_map_body));
}

void WindowTracker::ReportUncertainty(const Eigen::Vector3d& rate, TrackerOutput* out) const {
  out->information = window_.NewestInformation();
  out->covariance = CovarianceByMap(out->information, rate) + ExtrinsicsCovariance(state().T_map_body, rig_);
}

Matrix6d WindowTracker::CovarianceByMap(const Matrix15d& information, const Eigen::Vector3d& rate) const {
  return uncertainty_.Covariance(WindowCovariance(information), state().velocity, rate);
}

Matrix6d WindowTracker::SystematicUncertainty(const Eigen::Vector3d& rate) const {
  return uncertainty_.Systematic(state().velocity, rate);
}

Utime WindowTracker::MeanInterval() const {
  const std::deque<WindowNode>& nodes = window_.nodes();
  const auto steps = static_cast<Utime>(nodes.size()) - 1;
  return steps > 0 ? (nodes.back().t - nodes.front().t) / steps : 0;
}

void WindowTracker::Start(Utime t, const BodyState& state, const Matrix15d& information) {
  WindowNode node;
  node.t = t;
  ForgetMotion();
  probation_.Skip();
  rivals_.Start(t);
  node.state = state;
  // What its surface said is in the information already.
  const cv::Mat nothing(rig_.camera.height, rig_.camera.width, CV_8UC1, cv::Scalar(255));
  node.field = std::make_shared<SurfaceField>(nothing, 1);
  window_.Start({std::move(node)}, {state, information});
}

BodyState WindowTracker::Predict(const KeyframeInput& keyframe) const {
  const std::deque<WindowNode>& nodes = window_.nodes();
  BodyState predicted = state();
  switch (options_.window.motion_model) {
    case WindowOptions::MotionModel::kPreviousPose:
      break;
    case WindowOptions::MotionModel::kConstantVelocity: {
      if (nodes.size() < 2) break;
      const WindowNode &a = nodes[nodes.size() - 2], &b = nodes.back();
      const double s = ToSeconds(keyframe.t - b.t) / ToSeconds(b.t - a.t);
      const SE3 step = a.state.T_map_body.Inverse() * b.state.T_map_body;
      predicted.T_map_body.q = (predicted.T_map_body.q * ExpSO3(s * LogSO3(step.q))).normalized();
      predicted.T_map_body.p += s * (b.state.T_map_body.p - a.state.T_map_body.p);
      break;
    }
    case WindowOptions::MotionModel::kImu: {
      const NavState nav = PropagateImu({predicted.T_map_body, predicted.velocity}, keyframe.imu,
                                        predicted.bias, rig_.gravity);
      predicted.T_map_body = nav.T_map_body;
      predicted.velocity = nav.velocity;
    }
  }
  return predicted;
}

WindowNode WindowTracker::PredictedNode(const KeyframeInput& keyframe, const Eigen::Vector3d& rate) const {
  WindowNode node;
  node.t = keyframe.t;
  node.seq = keyframe.seq;
  node.state = Predict(keyframe);
  node.field = std::make_shared<SurfaceField>(keyframe.surface, 1);
  if (keyframe.n_events >= options_.min_events)
    node.points = points_->Select(node.state, rate, points_->affordable(), keyframe.seq);
  node.imu = std::make_shared<Preintegration>(keyframe.imu, state().bias, rig_.imu_noise);
  return node;
}

WindowTracker::Result WindowTracker::Process(const KeyframeInput& keyframe, const Eigen::Vector3d& rate,
                                             TrackerOutput* out) {
  steadiness_.Add(keyframe.imu);
  window_.Push(PredictedNode(keyframe, rate));
  std::vector<BodyState> predicted;
  for (const WindowNode& node : window_.nodes()) predicted.push_back(node.state);
  const SlidingWindow::Summary solve = window_.Solve();
  const WindowNode& newest = window_.nodes().back();
  out->iterations = solve.iterations;
  const AlignmentVerdict verdict =
      JudgeAlignment(alignment_, *newest.field, newest.points, newest.state.T_map_body);
  out->quality = verdict.quality;

  Result result;
  const double significance = verdict.significance;
  result.coasting = WhyCoast(keyframe, out->quality, significance);
  const bool seen = newest.points.size() > 0;
  if (result.coasting.empty()) {
    coasted_ = 0;
    started_gently_ = false;
    SetUncertainty(newest);
  } else {
    // A surface that the map does not lie on would only pull the pose away.
    window_.DropNewestAlignment(predicted);
    result.stands_still = StandsStill(keyframe, rate);
    if (result.stands_still) {
      window_.HoldNewest();
    } else {
      coasted_ += Interval();
    }
  }
  const bool tells = seen && !result.stands_still;
  if (tells) probation_.Add(significance);
  const std::string wrong = tells ? probation_.WhyFalse(keyframe.t) : "";
  ReportUncertainty(rate, out);

  const std::optional<SE3> rival =
      keyframe.n_events >= options_.min_events && !result.stands_still
          ? rivals_.Search(alignment_, *points_, keyframe, state(), rate, !result.coasting.empty())
          : std::nullopt;
  const std::string impossible = WhyImplausible(newest.state, options_.failure);
  result.failure = !solve.usable         ? "the solver failed"
                   : !impossible.empty() ? impossible
                   : !wrong.empty()      ? wrong
                   : rival               ? "another pose explains the events better"
                                         : WhyLost(result, CovarianceByMap(out->information, rate));
  result.restart = newest.state;
  if (!impossible.empty()) {
    // It has diverged: the prediction from the state before is the better place to look.
    result.restart = BodyState();
    result.restart.T_map_body = predicted.back().T_map_body;
  } else if (!wrong.empty()) {
    // Its velocity is as false as its pose.
    result.restart = BodyState();
    result.restart.T_map_body = newest.state.T_map_body;
  } else if (rival) {
    result.restart = BodyState();
    result.restart.T_map_body = *rival;
  }
  return result;
}

// Why the newest keyframe's events do not count; empty where they do.
std::string WindowTracker::WhyCoast(const KeyframeInput& keyframe, const AlignmentQuality& quality,
                                    double significance) const {
  if (keyframe.n_events == 0) return "no events";
  if (keyframe.n_events < options_.min_events) return "too few events";
  if (window_.nodes().back().points.size() < kMinPoints) return "no map points in view";
  // After long coasting the prediction leaves so much room that a pose fits noise as well as a false place
  // does. Keyframes that are far apart are no coasting.
  const double fits =
      coasted_ > 0 && coasted_ + Interval() > kLongCoasting ? kStartSignificance : kTrackingSignificance;
  if (!LiesOnEvents(quality, options_.failure.min_contrast, significance, fits))
    return "the map does not lie on the events";
  return "";
}

// us: from the keyframe before the newest to the newest.
Utime WindowTracker::Interval() const {
  const std::deque<WindowNode>& nodes = window_.nodes();
  return nodes.size() > 1 ? nodes.back().t - nodes[nodes.size() - 2].t : 0;
}

// Whether the body has stood still since the keyframe before, by the IMU alone: its events do not count.
bool WindowTracker::StandsStill(const KeyframeInput& keyframe, const Eigen::Vector3d& rate) {
  // A pose that would soon be LOST, or that a start has not confirmed, must not be kept for as long as the
  // body stands.
  constexpr double kKnown = 1. / 3;  // of the largest standard deviation of the position
  if (!probation_.Passed() || started_gently_ || keyframe.imu.size() < 2) return false;
  const std::optional<ImuSample> reading = steadiness_.SteadyReading(keyframe.imu.front().t);
  if (!reading) return false;
  const Matrix15d information = window_.NewestInformation();
  if (!MayStandStill(state(), information, reading->gyro)) return false;
  const std::deque<WindowNode>& nodes = window_.nodes();
  if (nodes.size() > 1 && nodes[nodes.size() - 2].stood_still) {
    // Nothing but events that fit tells how fast it is by now.
    started_gently_ = gentle_start_.Seen(reading->accel, ToSeconds(Interval()));
    return !started_gently_;
  }
  if (PositionSigma(CovarianceByMap(information, rate)) > kKnown * options_.failure.max_position_sigma_m)
    return false;
  gentle_start_.Begin(reading->accel);
  return true;
}

// Why coasting cannot continue; empty where it can.
std::string WindowTracker::WhyLost(const Result& result, const Matrix6d& covariance) const {
  if (result.coasting.empty() || result.stands_still) return "";
  const double coasted = ToSeconds(coasted_), sigma = PositionSigma(covariance);
  if (coasted <= options_.failure.max_coast_s && sigma <= options_.failure.max_position_sigma_m) return "";
  return result.coasting + FormatText(" for %.1f s, position known to %.2f m", coasted, sigma);
}

}  // namespace evit
