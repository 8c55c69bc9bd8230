#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "common/imu/imu_sample.h"
#include "common/localization/place_query.h"
#include "common/tracking/state.h"

namespace evit {

/// A place where the body may have been at one keyframe after the other.
struct FollowedPlace {
  struct Step {
    Utime t;
    SE3 T_map_body;
    double significance;
  };
  BodyState state;  // at its last step, or where the IMU has moved it since
  Utime at = 0;     // us: of that state
  std::vector<Step> steps;
  int weak = 0;  // last steps in a row that did not fit
  double likeness = 0;
  bool compared = false;  // the whole map was searched for what looks like it
  int n_points = 0;

  /// Significance over the newest steps.
  double Mean(std::size_t newest = std::numeric_limits<std::size_t>::max()) const;
  double Seconds() const { return ToSeconds(steps.back().t - steps.front().t); }
  /// By how much the view has changed, rad: by turning, and by moving as what lies 1.5 m away shows it.
  double Turn() const;
};

/// Places where the body may be: the IMU moves them from keyframe to keyframe, each is fitted there (by
/// PlaceFinder), and what does not fit is dropped.
class FollowedPlaces {
 public:
  /// Samples of [begin, end], us.
  using ImuBetween = std::function<std::vector<ImuSample>(Utime begin, Utime end)>;

  /// `most`: so many at a time. `worth_following`: significance of a place that is followed at all.
  FollowedPlaces(double gravity, std::size_t most, double worth_following)
      : gravity_(gravity), most_(most), worth_following_(worth_following) {}

  void Clear() { places_.clear(); }
  /// Drops those for whose T_map_body it is false: true where there were any.
  bool DropUnless(const std::function<bool(const SE3&)>& possible);
  bool empty() const { return places_.empty(); }
  const std::vector<FollowedPlace>& all() const { return places_; }

  /// Moves all to time t (us): T_map_body of each, as predicted.
  std::vector<SE3> MoveTo(Utime t, const ImuBetween& imu);
  /// The answer to a question about the keyframe of time t: its first `predicted` are those of MoveTo,
  /// fitted; what comes then are other places. `compared`: the map was searched for what looks like the most
  /// significant of the first ones.
  void AddAnswer(Utime t, std::size_t predicted, const std::vector<PlaceCandidate>& answer, bool compared);

  /// The most significant over all of its steps. Not for an empty set.
  const FollowedPlace& Best() const;
  /// How many explain the keyframes nearly as well, each over the time that it has been followed: by `lead`
  /// less at most.
  std::size_t Rivals(const FollowedPlace& best, double lead) const;

 private:
  void Fit(Utime t, const PlaceCandidate& fitted, FollowedPlace* place) const;
  void Adopt(Utime t, const PlaceCandidate& candidate);
  void DropWeak();

  double gravity_;
  std::size_t most_;
  double worth_following_;
  std::vector<FollowedPlace> places_;
};

}  // namespace evit
