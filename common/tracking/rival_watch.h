#pragma once

#include <optional>

#include "common/geometry/se3.h"
#include "common/time/utime.h"
#include "common/tracking/keyframe_input.h"
#include "common/tracking/point_selector.h"
#include "common/tracking/start_search.h"

namespace evit {

/// While tracking: looks from time to time whether another pose explains the events better than the one that
/// is tracked. A false pose beside a right one may look as sure as a right one elsewhere (on VECtor's
/// mountain_normal a significance of 9.5, 14 cm off), but next to the right one it loses by 6 to 8 standard
/// deviations, whereas poses beside a right one rarely win, and never twice in the same place.
class RivalWatch {
 public:
  /// Bootstrapping has ended at `t` (us): the first second is watched closely.
  void Start(Utime t);

  /// Where it is due, searches at this keyframe for a pose that explains its events better than `state`'s:
  /// FindRival and Confirm. `rate`: rad/s, body frame.
  std::optional<SE3> Search(const AlignmentSettings& settings, const PointSelector& points,
                            const KeyframeInput& keyframe, const BodyState& state,
                            const Eigen::Vector3d& rate, bool coasting);

  /// Whether to search at the keyframe at `t`. `coasting`: the map does not lie on its events.
  bool Due(Utime t, bool coasting) const;

  /// What the search (FindRival) at a keyframe with pose `T_map_body` found, `rival_significance` being the
  /// rival's own (AlignmentSignificance). The rival's pose once several keyframes in a row have shown it, at
  /// the same place seen from the body.
  std::optional<SE3> Confirm(Utime t, const SE3& T_map_body, const StartRival& rival,
                             double rival_significance);

 private:
  Utime started_at_ = 0;  // us
  Utime searched_at_ = 0;
  SE3 T_body_rival_;       // of the last rival
  int confirmations_ = 0;  // keyframes in a row that have shown it
};

}  // namespace evit
