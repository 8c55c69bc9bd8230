#include "common/tracking/bootstrapper.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "common/tracking/alignment_significance.h"
#include "common/tracking/gates.h"
#include "common/tracking/localizer.h"
#include "common/tracking/place_search.h"
#include "common/tracking/start_search.h"

namespace evit {
namespace {

constexpr StartRange kFollow{0.01, 0.006, 3};  // constant velocity and gyro over some 10 ms
constexpr int kPatience = 100;                 // frames that do not fit before the start counts as failed

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
    : rig_(rig), options_(options), alignment_(alignment), points_(points), chain_(options, alignment) {}

void Bootstrapper::Start(const BodyState& state) {
  state_ = state;
  chain_.Start(state);
  rejected_ = 0;
}

Bootstrapper::Result Bootstrapper::Process(const KeyframeInput& keyframe, bool follows,
                                           const Eigen::Vector3d& rate) {
  chain_.Begin(keyframe.t);
  Result result;
  auto field = std::make_shared<SurfaceField>(keyframe.surface, kStartRange.levels);
  std::shared_ptr<Preintegration> imu;
  if (follows) {
    imu = std::make_shared<Preintegration>(keyframe.imu, state_.bias, rig_.imu_noise);
    chain_.mutable_anchor()->Move(keyframe.imu, state_.bias, rig_.gravity, options_.failure.max_speed);
  }
  // In a chain of frames: rotation from the gyro, which is good without any start-up, position from the last
  // frames. At its beginning: from the anchor.
  const bool chained = !chain_.frames().empty() && imu != nullptr;
  const StartRange& range = chained ? kFollow : kStartRange;
  BodyState predicted = state_;
  if (chained) {
    predicted.T_map_body.q = (state_.T_map_body.q * imu->delta().gamma).normalized();
    predicted.T_map_body.p = state_.T_map_body.p + imu->dt() * state_.velocity;
  } else {
    predicted.T_map_body = chain_.anchor().pose();
    predicted.T_map_body =
        InitialPose(alignment_, *points_, *field, predicted, rate, rejected_, keyframe.seq);
  }
  result.points = points_->Select(predicted, rate, points_->per_keyframe(), keyframe.seq);
  const LocalizerResult fit =
      chained ? LocalizeBest(alignment_, *field, result.points, predicted.T_map_body, range)
              : SearchStart(alignment_, *field, result.points, predicted.T_map_body, range, keyframe.seq);
  result.quality = fit.quality;
  result.iterations = fit.iterations;
  if (!WithinReach(fit.T_map_body, predicted.T_map_body, range) ||
      !LiesOnEvents(fit.quality, options_.bootstrap.min_contrast, fit.significance,
                    chained ? kFollowSignificance : kStartSignificance)) {
    RejectFrame(&result);
    return result;
  }
  state_.T_map_body = fit.T_map_body;
  chain_.Add({{keyframe.t, fit.T_map_body, imu},
              keyframe.seq,
              fit.significance,
              keyframe.n_events,
              field,
              result.points});
  state_.velocity = chain_.RecentVelocity();
  if (state_.velocity.norm() > options_.failure.max_speed) {
    RejectFrame(&result);
  } else {
    Judge(*field, &result);
  }
  return result;
}

// What the chain proves with the newest frame.
void Bootstrapper::Judge(const SurfaceField& field, Result* result) {
  result->status = Result::Status::kUnsure;
  const StartChain::Verdict verdict = chain_.Judge(field, result->points);
  switch (verdict) {
    case StartChain::Verdict::kUnsure:
      return;
    case StartChain::Verdict::kFalse:
      RejectFrame(result);
      return;
    case StartChain::Verdict::kElsewhere:
      state_.T_map_body = chain_.anchor().pose();
      state_.velocity.setZero();
      rejected_ = 0;
      return;
    case StartChain::Verdict::kFound:
    case StartChain::Verdict::kDoubted:
    case StartChain::Verdict::kProven:
      break;
  }
  rejected_ = 0;
  result->status = Result::Status::kLocalized;
  result->reason = verdict == StartChain::Verdict::kDoubted ? "another pose explains the events as well"
                                                            : "localising high-rate frames";
  if (verdict == StartChain::Verdict::kProven) Align(result);
}

void Bootstrapper::RejectFrame(Result* result) {
  chain_.Break();
  state_.T_map_body = chain_.anchor().pose();
  state_.velocity = chain_.anchor().velocity();
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

void Bootstrapper::Align(Result* result) {
  std::vector<BootstrapFrame> chain;
  for (const StartChain::Frame& f : chain_.frames()) chain.push_back(f.frame);
  const VisualInertialAlignment aligned =
      AlignVisualInertial(chain, rig_.gravity, options_.bootstrap, options_.window.imu_noise_factor);
  if (!aligned.success) {
    result->reason = "visual-inertial alignment rejected: " + aligned.reason;
    chain_.DropHalf();
    return;
  }
  std::vector<StartChain::Frame> frames = chain_.Take();
  const auto n_window = std::min<std::size_t>(frames.size(), options_.window.size);
  for (std::size_t k = frames.size() - n_window; k < frames.size(); ++k) {
    StartChain::Frame& f = frames[k];
    result->window.push_back(
        {f.frame.t, f.seq, aligned.states[k], std::move(f.field), std::move(f.points), f.frame.imu});
  }
  result->prior = FirstPrior(result->window.front().state, state_.bias);
  result->status = Result::Status::kAligned;
}

}  // namespace evit
