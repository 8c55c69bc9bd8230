#include "common/localization/self_locator.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "common/imu/propagation.h"
#include "common/localization/prior_text.h"
#include "common/localization/upright.h"
#include "common/text/format_text.h"
#include "common/tracking/alignment_significance.h"
#include "common/tracking/visual_inertial_alignment.h"

namespace evit {
namespace {

constexpr Utime kPatience = 3'000'000;  // us: keyframes kept while an answer is awaited
constexpr std::size_t kBacklog = 6;     // keyframes waiting, from which every other is left out
constexpr std::size_t kConvincing =
    4;  // newest steps of a place that have to fit well, before others are searched
constexpr double kKnownScale = 0.1;  // sigma of the map's size, where it is in doubt
constexpr double kPriorSlack = 0.2;  // m, rad: a place a little outside of what is known may still be right
constexpr double kPoseSigma = 0.01;  // m, rad: of an event-only pose, for the alignment with the IMU

}  // namespace

SelfLocator::SelfLocator(const Rig& rig, const TrackerOptions& tracker, const SelfLocatorOptions& options)
    : rig_(rig),
      tracker_(tracker),
      options_(options),
      places_(rig.gravity, options.max_hypotheses, options.worth_following),
      searches_(options.again_s) {}

void SelfLocator::Restart() {
  imu_.Clear();
  views_.clear();
  question_.reset();
  places_.Clear();
  newest_ = {0, {}};
  searches_.Clear();
  found_at_ = 0;
  progress_ = "waiting for IMU samples";
}

FollowedPlaces::ImuBetween SelfLocator::Imu() const {
  return [this](Utime begin, Utime end) { return imu_.Between(begin, end); };
}

void SelfLocator::SetPrior(const PlacePrior& prior) {
  options_.prior = prior;
  const bool dropped = places_.DropUnless(
      [&prior](const SE3& T_map_body) { return prior.Allows(T_map_body, kPriorSlack, kPriorSlack); });
  // The pending question is about dropped places too. If none is left, the whole map is searched at once.
  if (dropped && found_at_ == 0) question_.reset();
  if (dropped && places_.empty()) searches_.Clear();
}

void SelfLocator::AddImu(const KeyframeInput& keyframe) {
  const Utime kept = static_cast<Utime>(options_.up_s * 1e6) + 2 * kPatience;
  if (!imu_.Add(keyframe, 1e3 * tracker_.failure.max_imu_gap_ms, kept)) {
    Restart();
    imu_.Add(keyframe, 1e3 * tracker_.failure.max_imu_gap_ms, kept);
  }
}

void SelfLocator::AddKeyframe(const KeyframeInput& keyframe) {
  AddImu(keyframe);
  if (!views_.empty() && keyframe.t - views_.front().t > kPatience) {
    // The answer will be too late to be of use, or there is nobody who answers.
    views_.clear();
    places_.Clear();
    question_.reset();
  }
  if (keyframe.t - newest_.t >= static_cast<Utime>(options_.step_ms * 1e3) || keyframe.t <= newest_.t) {
    newest_ = {keyframe.t, keyframe.surface.clone()};
    views_.push_back(newest_);
  }
  AskNext();
}

// One question at a time: the next keyframe for what is followed, or, where nothing is, the whole map for the
// newest; that one also where what is followed does not convince.
void SelfLocator::AskNext() {
  if (question_ || newest_.t == 0 || found_at_ != 0) return;
  comparing_ = false;
  if (places_.empty()) views_.clear();
  if (views_.empty()) {
    if (!Convinced() && searches_.Due(newest_.t, false)) AskEverywhere(newest_, {});
    return;
  }
  if (views_.size() > kBacklog) views_.pop_front();  // late: longer steps catch up
  const View view = std::move(views_.front());
  views_.pop_front();
  std::vector<SE3> predicted = places_.MoveTo(view.t, Imu());
  comparing_ = ToCompare() && searches_.Due(view.t, false);
  if (comparing_) {
    AskForPlacesLikeTheBest(view, std::move(predicted));
    return;
  }
  if (searches_.Due(view.t, Convinced())) AskEverywhere(view, predicted);
  if (question_) return;
  question_ =
      PlaceQuery{++asked_, view.t, view.surface, Eigen::Vector3d::UnitZ(), false, std::move(predicted), {}};
}

// Whether the best place convinces, and the rest of the map has not been compared with it yet: before it
// counts as found, whatever looks like it has to be followed too.
bool SelfLocator::ToCompare() const {
  if (places_.empty()) return false;
  const FollowedPlace& best = places_.Best();
  return !best.compared && best.steps.size() >= kConvincing && best.Mean() >= options_.patient_significance;
}

bool SelfLocator::Convinced() const {
  return std::any_of(places_.all().begin(), places_.all().end(), [&](const FollowedPlace& place) {
    return place.Mean(kConvincing) >= options_.patient_significance;
  });
}

void SelfLocator::AskEverywhere(const View& view, std::vector<SE3> hypotheses) {
  const std::vector<ImuSample> before =
      imu_.Between(view.t - static_cast<Utime>(options_.up_s * 1e6), view.t);
  if (before.empty() ||
      ToSeconds(view.t - before.front().t) < std::min(options_.least_up_s, 0.9 * options_.up_s)) {
    return;
  }
  const Upright upright = EstimateUpright(before, rig_.gravity);
  if (!upright.known) {
    progress_ = "the accelerometer shows no gravity";
    return;
  }
  const Eigen::Vector3d tried = searches_.Begin(view.t, upright, imu_);
  const Eigen::Vector3d up = options_.other_verticals ? tried : upright.up;
  question_ = PlaceQuery{++asked_, view.t, view.surface, up, true, std::move(hypotheses), options_.prior};
  if (places_.empty()) progress_ = "searching " + Searched();
}

void SelfLocator::AskForPlacesLikeTheBest(const View& view, std::vector<SE3> hypotheses) {
  searches_.BeginComparison(view.t);
  // The place's own pose knows the vertical best.
  const Eigen::Vector3d up = places_.Best().state.T_map_body.q.conjugate() * Eigen::Vector3d::UnitZ();
  question_ = PlaceQuery{++asked_, view.t, view.surface, up, true, std::move(hypotheses), options_.prior};
}

std::string SelfLocator::Searched() const {
  return options_.prior.open() ? "the map" : "the map " + PriorText(options_.prior);
}

void SelfLocator::AddAnswer(const std::vector<PlaceCandidate>& answer) {
  if (!question_) return;
  // Only for what fits this keyframe well does the finder look for places alike.
  const std::size_t predicted = std::min(question_->hypotheses.size(), answer.size());
  const bool compared =
      comparing_ && std::any_of(answer.begin(), answer.begin() + predicted,
                                [](const auto& a) { return a.significance >= kStartSignificance; });
  places_.AddAnswer(question_->t, predicted, answer, compared);
  question_.reset();
  Decide();
  AskNext();
}

void SelfLocator::Decide() {
  if (places_.empty()) {
    progress_ = "nothing in " + Searched() + " looks like what the events show";
    return;
  }
  const FollowedPlace& best = places_.Best();
  const double since = best.Seconds();
  progress_ = FormatText("places followed: %zu, the best for %.1f s at a significance of %.1f",
                         places_.all().size(), since, best.Mean());
  if (since < options_.follow_s || static_cast<int>(best.steps.size()) < options_.least_steps ||
      best.Turn() < options_.least_turn || best.weak > 0) {
    return;
  }
  const bool patient = since >= 2 * options_.follow_s;
  if (best.Mean() < (patient ? options_.patient_significance : options_.least_significance)) return;
  const double lead = patient ? options_.patient_lead : options_.least_lead;
  if (!best.compared) {
    progress_ = "a place fits; comparing it with the rest of the map";
    return;
  }
  if (const std::size_t rivals = places_.Rivals(best, lead); rivals > 0) {
    progress_ = FormatText("ambiguous: %zu places look alike", rivals + 1);
    return;
  }
  const std::optional<MotionFit> fit =
      FitMotion(best.steps, imu_.Between(best.steps.front().t, best.steps.back().t), rig_.gravity);
  if (const std::string wrong = WhatDisagrees(fit); !wrong.empty()) {
    progress_ = wrong;
    return;
  }
  if (!Aligned(best.steps, fit->fitting, &found_)) {
    progress_ = "a place fits the events, but its motion does not fit the IMU";
    return;
  }
  found_at_ = best.steps[fit->fitting.back()].t;
  progress_ = "found";
}

std::string SelfLocator::WrongScale(const MotionFit& fit) {
  return FormatText("the map is %.2f +- %.2f times as large as the accelerometer says: is it in metres?",
                    fit.scale, fit.scale_sigma);
}

// What the accelerometer says against the place's motion; empty: nothing.
std::string SelfLocator::WhatDisagrees(const std::optional<MotionFit>& fit) const {
  if (!fit) return "too few poses";
  if (fit->Disagrees()) return WrongScale(*fit);
  if (doubts_scale_ && fit->scale_sigma > kKnownScale)
    return "a place fits; waiting for motion that shows how large the map is";
  return "";
}

// Whether the poses of a hypothesis are those of a body with this IMU: velocities and biases exist that a
// sensor can have.
bool SelfLocator::Aligned(const std::vector<FollowedPlace::Step>& steps,
                          const std::vector<std::size_t>& fitting, BodyState* state) const {
  std::vector<BootstrapFrame> frames;
  const std::size_t n = fitting.size(), most = 40;
  for (std::size_t k = n > most ? n - most : 0; k < n; ++k) {
    const FollowedPlace::Step& step = steps[fitting[k]];
    BootstrapFrame frame{step.t, step.T_map_body, nullptr};
    if (!frames.empty()) {
      frame.imu =
          std::make_shared<Preintegration>(imu_.Between(frames.back().t, step.t), ImuBias{}, rig_.imu_noise);
    }
    frames.push_back(std::move(frame));
  }
  const VisualInertialAlignment aligned = AlignVisualInertial(
      frames, rig_.gravity, tracker_.bootstrap, tracker_.window.imu_noise_factor, kPoseSigma, kPoseSigma);
  if (!aligned.success) return false;
  *state = aligned.states.back();
  return state->velocity.norm() <= tracker_.failure.max_speed;
}

std::optional<BodyState> SelfLocator::Found() const {
  if (found_at_ == 0) return std::nullopt;
  BodyState state = found_;
  const std::vector<ImuSample> since = imu_.Between(found_at_, imu_.newest());
  if (since.size() < 2) return state;
  const NavState now = PropagateImu({state.T_map_body, state.velocity}, since, state.bias, rig_.gravity);
  state.T_map_body = now.T_map_body;
  state.velocity = now.velocity;
  return state;
}

std::string SelfLocator::Progress() const { return progress_; }

}  // namespace evit
