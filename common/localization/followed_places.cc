#include "common/localization/followed_places.h"

#include <algorithm>
#include <utility>

#include "common/imu/propagation.h"

namespace evit {
namespace {

constexpr double kFits = 3.5;           // significance of a step that fits
constexpr int kMaxWeak = 2;             // steps in a row that do not, before a place is dropped
constexpr double kSame = 0.03;          // m, rad: two places in one valley
constexpr double kLonger = 0.5;         // of significance, which is chance between two of them
constexpr double kVelocityGain = 0.6;   // of what a step says of the velocity
constexpr double kViewDepth = 1.5;      // m: what lies there moves over the image as by this turn
constexpr std::size_t kMaxSteps = 100;  // 5 s: what was earlier says no more

bool SamePose(const SE3& a, const SE3& b) {
  return (a.p - b.p).norm() < kSame && AngularDistance(a.q, b.q) < kSame;
}

// Of two places that have come to lie in one valley: whether `a` has explained the events better on the way.
// The other one has come from elsewhere, and where it was before does not go with the motion. About equal:
// the one followed for longer.
bool Better(const FollowedPlace& a, const FollowedPlace& b) {
  const std::size_t common = std::min(a.steps.size(), b.steps.size());
  const double longer = a.steps.size() > b.steps.size()   ? kLonger
                        : a.steps.size() < b.steps.size() ? -kLonger
                                                          : 0;
  return a.Mean(common) + longer > b.Mean(common);
}

}  // namespace

double FollowedPlace::Mean(std::size_t newest) const {
  const std::size_t n = std::min(newest, steps.size());
  double sum = 0;
  for (std::size_t k = steps.size() - n; k < steps.size(); ++k) sum += steps[k].significance;
  return sum / static_cast<double>(n);
}

double FollowedPlace::Turn() const {
  double turn = 0;
  for (std::size_t k = 1; k < steps.size(); ++k) {
    const SE3 &a = steps[k - 1].T_map_body, &b = steps[k].T_map_body;
    turn += AngularDistance(a.q, b.q) + (b.p - a.p).norm() / kViewDepth;
  }
  return turn;
}

bool FollowedPlaces::DropUnless(const std::function<bool(const SE3&)>& possible) {
  const auto gone = std::remove_if(places_.begin(), places_.end(), [&](const FollowedPlace& place) {
    return !possible(place.state.T_map_body);
  });
  const bool any = gone != places_.end();
  places_.erase(gone, places_.end());
  return any;
}

std::vector<SE3> FollowedPlaces::MoveTo(Utime t, const ImuBetween& imu) {
  std::vector<SE3> predicted;
  for (FollowedPlace& place : places_) {
    const NavState state = PropagateImu({place.state.T_map_body, place.state.velocity}, imu(place.at, t),
                                        place.state.bias, gravity_);
    place.state.T_map_body = state.T_map_body;
    place.state.velocity = state.velocity;
    place.at = t;
    predicted.push_back(state.T_map_body);
  }
  return predicted;
}

void FollowedPlaces::AddAnswer(Utime t, std::size_t predicted, const std::vector<PlaceCandidate>& answer,
                               bool compared) {
  const std::size_t n = std::min({places_.size(), predicted, answer.size()});
  std::size_t best = 0;
  for (std::size_t k = 0; k < n; ++k) {
    Fit(t, answer[k], &places_[k]);
    if (answer[k].significance > answer[best].significance) best = k;
  }
  if (compared && n > 0) places_[best].compared = true;
  for (std::size_t k = predicted; k < answer.size(); ++k) Adopt(t, answer[k]);
  DropWeak();
}

void FollowedPlaces::Fit(Utime t, const PlaceCandidate& fitted, FollowedPlace* place) const {
  FollowedPlace& p = *place;
  const double dt = ToSeconds(t - p.steps.back().t);
  const double gain = p.steps.size() == 1 ? 1 : kVelocityGain;
  p.weak = fitted.significance < kFits ? p.weak + 1 : 0;
  if (p.weak == 0) {
    p.state.velocity += gain / dt * (fitted.T_map_body.p - p.state.T_map_body.p);
    p.state.T_map_body = fitted.T_map_body;
  }
  p.n_points = fitted.n_points;
  if (p.steps.size() == kMaxSteps) p.steps.erase(p.steps.begin());
  p.steps.push_back({t, p.state.T_map_body, fitted.significance});
}

void FollowedPlaces::Adopt(Utime t, const PlaceCandidate& candidate) {
  if (candidate.significance < worth_following_) return;
  for (const FollowedPlace& place : places_)
    if (SamePose(place.state.T_map_body, candidate.T_map_body)) return;
  FollowedPlace place;
  place.state.T_map_body = candidate.T_map_body;
  place.at = t;
  place.steps.push_back({t, candidate.T_map_body, candidate.significance});
  place.likeness = candidate.likeness;
  place.n_points = candidate.n_points;
  places_.push_back(std::move(place));
}

// What does not fit any more, what has come to lie in another's valley, and of too many the least
// significant.
void FollowedPlaces::DropWeak() {
  std::vector<FollowedPlace> kept;
  for (FollowedPlace& place : places_) {
    if (place.weak >= kMaxWeak) continue;
    const auto same = std::find_if(kept.begin(), kept.end(), [&](const FollowedPlace& k) {
      return SamePose(k.state.T_map_body, place.state.T_map_body);
    });
    if (same == kept.end()) {
      kept.push_back(std::move(place));
    } else if (Better(place, *same)) {
      *same = std::move(place);
    }
  }
  places_ = std::move(kept);
  std::stable_sort(places_.begin(), places_.end(), [](const FollowedPlace& a, const FollowedPlace& b) {
    return a.steps.back().significance > b.steps.back().significance;
  });
  if (places_.size() > most_) places_.resize(most_);
}

const FollowedPlace& FollowedPlaces::Best() const {
  return *std::max_element(
      places_.begin(), places_.end(),
      [](const FollowedPlace& a, const FollowedPlace& b) { return a.Mean() < b.Mean(); });
}

std::size_t FollowedPlaces::Rivals(const FollowedPlace& best, double lead) const {
  return static_cast<std::size_t>(
      std::count_if(places_.begin(), places_.end(), [&](const FollowedPlace& place) {
        const std::size_t common = std::min(place.steps.size(), best.steps.size());
        return &place != &best && place.Mean(common) > best.Mean(common) - lead;
      }));
}

}  // namespace evit
