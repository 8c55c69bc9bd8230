#pragma once

#include "common/localization/recent_imu.h"
#include "common/localization/vertical_search.h"

namespace evit {

/// When to search the whole map, and with which vertical: a few searches at once at first, then so many a
/// second while nothing that has been found convinces, and rarely from then on.
class SearchSchedule {
 public:
  /// `again_s`: between searches while something convinces.
  explicit SearchSchedule(double again_s) : again_s_(again_s) {}

  /// As if no search had been yet.
  void Clear();
  /// Whether the keyframe at t (us) is to be searched for. `convinced`: what is followed explains the events.
  bool Due(Utime t, bool convinced) const;
  /// There is a search at t: returns its vertical, body frame. `imu` reaches back to the search before, if it
  /// was not long ago.
  Eigen::Vector3d Begin(Utime t, const Upright& upright, const RecentImu& imu);
  /// There is one whose vertical is known: it costs as much, and says nothing of other verticals.
  void BeginComparison(Utime t);

 private:
  double Allowed(Utime t) const;

  double again_s_;
  VerticalSearch verticals_;
  Utime tried_at_ = 0;  // us, of the newest vertical; 0: none yet
  Utime last_ = 0;      // us, of the newest search; 0: none yet
  double allowed_ = 0;  // searches, then
};

}  // namespace evit
