#include "common/localization/self_locator.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "common/imu/propagation.h"
#include "common/localization/upright.h"
#include "common/text/format_text.h"
#include "common/tracking/visual_inertial_alignment.h"

namespace evit {
namespace {

constexpr Utime kPatience = 3'000'000;  // us: keyframes kept while an answer is awaited
constexpr std::size_t kBacklog = 6;     // keyframes waiting, from which every other is left out
constexpr Utime kRetry = 200'000;       // us between searches everywhere that found nothing worth following
constexpr double kFits = 3.5;           // significance of a step that fits
constexpr int kMaxWeak = 2;             // steps in a row that do not, before a hypothesis is dropped
constexpr double kSame = 0.03;          // m, rad: two hypotheses in one valley
constexpr double kVelocityGain = 0.6;   // of what a step says of the velocity
constexpr double kViewDepth = 1.5;      // m: what lies there moves over the image as by this turn
constexpr double kUnsureUp = 0.05;      // rad: from which the next search tries another vertical
constexpr double kPoseSigma = 0.01;     // m, rad: of an event-only pose, for the alignment with the IMU

bool SamePose(const SE3& a, const SE3& b) {
  return (a.p - b.p).norm() < kSame && AngularDistance(a.q, b.q) < kSame;
}

// Of attempts one after the other: the vertical as estimated, then tilted by its uncertainty to four sides.
Eigen::Vector3d Tilted(const Upright& upright, std::int64_t attempt) {
  const int side = static_cast<int>(attempt % 5);
  if (side == 0 || upright.sigma < kUnsureUp) return upright.up;
  const Eigen::Vector3d a = upright.up.unitOrthogonal(), b = upright.up.cross(a);
  const Eigen::Vector3d axis = side == 1 ? a : side == 2 ? -a : side == 3 ? b : Eigen::Vector3d(-b);
  return ExpSO3(1.5 * upright.sigma * axis) * upright.up;
}

}  // namespace

SelfLocator::SelfLocator(const Rig& rig, const TrackerOptions& tracker, const SelfLocatorOptions& options)
    : rig_(rig), tracker_(tracker), options_(options) {}

void SelfLocator::Restart() {
  imu_.clear();
  views_.clear();
  question_.reset();
  hypotheses_.clear();
  searched_ = last_view_ = 0;
  found_.reset();
  progress_ = "waiting for IMU samples";
}

void SelfLocator::AddKeyframe(const KeyframeInput& keyframe) {
  if (!imu_.empty() && (keyframe.imu.empty() || keyframe.imu.front().t != imu_.back().t ||
                        1e-3 * static_cast<double>(keyframe.imu_gap) > tracker_.failure.max_imu_gap_ms)) {
    Restart();
  }
  for (const ImuSample& sample : keyframe.imu)
    if (imu_.empty() || sample.t > imu_.back().t) imu_.push_back(sample);
  const Utime kept = static_cast<Utime>(options_.up_s * 1e6) + 2 * kPatience;
  while (!imu_.empty() && imu_.front().t < keyframe.t - kept) imu_.pop_front();
  if (!views_.empty() && keyframe.t - views_.front().t > kPatience) {
    // The answer will be too late to be of use, or there is nobody who answers.
    views_.clear();
    hypotheses_.clear();
    question_.reset();
  }
  if (keyframe.t - last_view_ >= static_cast<Utime>(options_.step_ms * 1e3) || keyframe.t <= last_view_) {
    views_.push_back({keyframe.t, keyframe.surface.clone()});
    last_view_ = keyframe.t;
  }
  AskNext();
}

// One question at a time: the next keyframe for what is followed, or, where nothing is, the whole map for the
// newest.
void SelfLocator::AskNext() {
  if (question_ || views_.empty() || found_) return;
  if (hypotheses_.empty()) {
    views_.erase(views_.begin(), views_.end() - 1);
    if (searched_ != 0 && views_.back().t < searched_ + kRetry) return;
    AskEverywhere(views_.back(), {});
    if (question_) views_.pop_back();
    return;
  }
  if (views_.size() > kBacklog) views_.pop_front();  // late: longer steps catch up
  const View view = std::move(views_.front());
  views_.pop_front();
  std::vector<SE3> predicted;
  for (Hypothesis& h : hypotheses_) {
    NavState state{h.state.T_map_body, h.state.velocity};
    state = PropagateImu(state, ImuBetween(h.steps.back().t, view.t), h.state.bias, rig_.gravity);
    h.state.T_map_body = state.T_map_body;
    h.state.velocity = state.velocity;
    predicted.push_back(state.T_map_body);
  }
  if (ToSeconds(view.t - searched_) >= options_.again_s) {
    AskEverywhere(view, predicted);
    if (question_) return;
  }
  question_ =
      PlaceQuery{++asked_, view.t, view.surface, Eigen::Vector3d::UnitZ(), false, std::move(predicted), {}};
}

void SelfLocator::AskEverywhere(const View& view, std::vector<SE3> hypotheses) {
  const std::vector<ImuSample> before = ImuBetween(view.t - static_cast<Utime>(options_.up_s * 1e6), view.t);
  if (before.empty() || ToSeconds(view.t - before.front().t) < options_.least_up_s) return;
  const Upright upright = EstimateUpright(before, rig_.gravity);
  if (!upright.known) {
    progress_ = "the accelerometer shows no gravity";
    return;
  }
  searched_ = view.t;
  question_ = PlaceQuery{
      ++asked_, view.t, view.surface, Tilted(upright, asked_), true, std::move(hypotheses), options_.prior};
  if (hypotheses_.empty()) progress_ = "searching the whole map";
}

void SelfLocator::AddAnswer(const std::vector<PlaceCandidate>& answer) {
  if (!question_) return;
  Follow(answer);
  for (std::size_t k = question_->hypotheses.size(); k < answer.size(); ++k) Adopt(answer[k]);
  DropWeak();
  question_.reset();
  Decide();
  AskNext();
}

void SelfLocator::Follow(const std::vector<PlaceCandidate>& answer) {
  const std::size_t n = std::min({hypotheses_.size(), question_->hypotheses.size(), answer.size()});
  for (std::size_t k = 0; k < n; ++k) {
    Hypothesis& h = hypotheses_[k];
    const PlaceCandidate& refined = answer[k];
    const double dt = ToSeconds(question_->t - h.steps.back().t);
    const double gain = h.steps.size() == 1 ? 1 : kVelocityGain;
    h.weak = refined.significance < kFits ? h.weak + 1 : 0;
    if (h.weak == 0) {
      h.state.velocity += gain / dt * (refined.T_map_body.p - h.state.T_map_body.p);
      h.state.T_map_body = refined.T_map_body;
    }
    h.n_points = refined.n_points;
    h.steps.push_back({question_->t, h.state.T_map_body, refined.significance});
  }
}

void SelfLocator::Adopt(const PlaceCandidate& candidate) {
  if (candidate.significance < options_.worth_following) return;
  for (const Hypothesis& h : hypotheses_)
    if (SamePose(h.state.T_map_body, candidate.T_map_body)) return;
  Hypothesis h;
  h.state.T_map_body = candidate.T_map_body;
  h.steps.push_back({question_->t, candidate.T_map_body, candidate.significance});
  h.likeness = candidate.likeness;
  h.n_points = candidate.n_points;
  hypotheses_.push_back(std::move(h));
}

// What does not fit any more, what has come to lie in another's valley (the younger of two), and of too many
// the least significant.
void SelfLocator::DropWeak() {
  std::vector<Hypothesis> kept;
  for (Hypothesis& h : hypotheses_) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Hypothesis& k) {
      return SamePose(k.state.T_map_body, h.state.T_map_body);
    });
    if (h.weak < kMaxWeak && !known) kept.push_back(std::move(h));
  }
  hypotheses_ = std::move(kept);
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.steps.back().significance > b.steps.back().significance;
  });
  if (hypotheses_.size() > options_.max_hypotheses) hypotheses_.resize(options_.max_hypotheses);
}

double SelfLocator::Hypothesis::Mean(std::size_t newest) const {
  const std::size_t n = std::min(newest, steps.size());
  double sum = 0;
  for (std::size_t k = steps.size() - n; k < steps.size(); ++k) sum += steps[k].significance;
  return sum / static_cast<double>(n);
}

// Those that explain the keyframes nearly as well as `best`, each over the time that it has been followed.
std::size_t SelfLocator::Rivals(const Hypothesis& best) const {
  return static_cast<std::size_t>(
      std::count_if(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& h) {
        const std::size_t common = std::min(h.steps.size(), best.steps.size());
        return &h != &best && h.Mean(common) > best.Mean(common) - options_.least_lead;
      }));
}

void SelfLocator::Decide() {
  if (hypotheses_.empty()) {
    progress_ = "nothing in the map looks like what the events show";
    return;
  }
  const Hypothesis& best =
      *std::max_element(hypotheses_.begin(), hypotheses_.end(),
                        [](const Hypothesis& a, const Hypothesis& b) { return a.Mean() < b.Mean(); });
  const double since = ToSeconds(best.steps.back().t - best.steps.front().t);
  double turn = 0;
  for (std::size_t k = 1; k < best.steps.size(); ++k) {
    const SE3 &a = best.steps[k - 1].T_map_body, &b = best.steps[k].T_map_body;
    turn += AngularDistance(a.q, b.q) + (b.p - a.p).norm() / kViewDepth;
  }
  progress_ = FormatText("following %zu places, the best for %.1f s at a significance of %.1f",
                         hypotheses_.size(), since, best.Mean());
  if (since < options_.follow_s || static_cast<int>(best.steps.size()) < options_.least_steps ||
      turn < options_.least_turn || best.weak > 0) {
    return;
  }
  const double least =
      since < 2 * options_.follow_s ? options_.least_significance : options_.patient_significance;
  if (best.Mean() < least) return;
  if (const std::size_t rivals = Rivals(best); rivals > 0) {
    progress_ = FormatText("ambiguous: %zu places look alike", rivals + 1);
    return;
  }
  if (!Aligned(best, &found_state_)) {
    progress_ = "a place fits the events, but its motion does not fit the IMU";
    return;
  }
  found_ = best.steps.back();
  progress_ = "found";
}

// Whether the poses of a hypothesis are those of a body with this IMU: velocities and biases exist that a
// sensor can have.
bool SelfLocator::Aligned(const Hypothesis& hypothesis, BodyState* state) const {
  std::vector<BootstrapFrame> frames;
  const std::size_t n = hypothesis.steps.size(), most = 40;
  for (std::size_t k = n > most ? n - most : 0; k < n; ++k) {
    const Step& step = hypothesis.steps[k];
    BootstrapFrame frame{step.t, step.T_map_body, nullptr};
    if (!frames.empty()) {
      frame.imu =
          std::make_shared<Preintegration>(ImuBetween(frames.back().t, step.t), ImuBias{}, rig_.imu_noise);
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
  if (!found_) return std::nullopt;
  BodyState state = found_state_;
  const std::vector<ImuSample> since = ImuBetween(found_->t, imu_.back().t);
  if (since.size() < 2) return state;
  const NavState now = PropagateImu({state.T_map_body, state.velocity}, since, state.bias, rig_.gravity);
  state.T_map_body = now.T_map_body;
  state.velocity = now.velocity;
  return state;
}

std::string SelfLocator::Progress() const { return progress_; }

std::vector<PlaceCandidate> SelfLocator::Followed() const {
  std::vector<PlaceCandidate> followed;
  for (const Hypothesis& h : hypotheses_) {
    followed.push_back({h.state.T_map_body, h.Mean(), h.likeness, h.n_points});
  }
  std::stable_sort(followed.begin(), followed.end(), [](const PlaceCandidate& a, const PlaceCandidate& b) {
    return a.significance > b.significance;
  });
  return followed;
}

// Samples of [begin, end]; keyframes' stamps are among them.
std::vector<ImuSample> SelfLocator::ImuBetween(Utime begin, Utime end) const {
  const auto before = [](const ImuSample& s, Utime t) { return s.t < t; };
  const auto from = std::lower_bound(imu_.begin(), imu_.end(), begin, before);
  const auto to = std::lower_bound(from, imu_.end(), end + 1, before);
  return {from, to};
}

}  // namespace evit
