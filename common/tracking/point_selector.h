#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/rig.h"
#include "common/map/map_index.h"
#include "common/tracking/active_points.h"
#include "common/tracking/event_alignment.h"
#include "common/tracking/state.h"
#include "common/tracking/tracker_options.h"

namespace evit {

/// Which map points a keyframe is aligned with (paper Sec. III-D): asks the map for those in a wide frustum
/// of the predicted pose, keeps what is in view, and draws a random subset for each keyframe.
class PointSelector {
 public:
  static constexpr Utime kQueryAhead =
      20'000;                                // us ahead of the newest keyframe, where nothing better is known
  static constexpr double kLeadShare = 0.5;  // of the margin: how far beyond the next view is asked for
  static constexpr Utime kFarthestAhead = 50'000;  // us: beyond that a prediction leaves the margin anyway

  /// `lag_px`: how far events are behind the edges that cause them.
  PointSelector(const Rig& rig, const AlignmentSettings& alignment, const PointOptions& options,
                double lag_px);

  /// The view of the map from this pose of the body.
  VisibilityQuery QueryFrom(const SE3& T_map_body) const;
  /// Whether the points at hand, the answer to `answered`, do for `query` too: the view has moved less than
  /// its margin, so that nothing can have come into the image that was not in view then.
  bool Suffice(const VisibilityQuery& answered, const VisibilityQuery& query) const;
  /// Answer to it (ids: indices into the map; points: map frame, m). Of the points so far those stay that are
  /// in view from one of `T_map_body`, so that a point does not come and go with the random subset of each
  /// answer.
  void Add(const std::vector<std::int32_t>& ids, const std::vector<Eigen::Vector3f>& points,
           const std::vector<SE3>& T_map_body);
  void Clear() { active_.Clear(); }

  /// At most `count` points for keyframe `seq`, expected at this state and angular rate (rad/s, body frame):
  /// where its events show them.
  AlignmentPoints Select(const BodyState& predicted, const Eigen::Vector3d& rate, int count,
                         std::int64_t seq) const;

  /// Points of one keyframe, and how many of them overload leaves.
  int per_keyframe() const { return options_.per_keyframe; }
  int affordable() const { return static_cast<int>(share_ * options_.per_keyframe); }
  void set_share(double share) { share_ = share; }

 private:
  Camera camera_;
  SE3 T_body_camera_;
  AlignmentSettings alignment_;
  PointOptions options_;
  double lag_px_;
  double share_ = 1;
  ActivePoints active_;
};

}  // namespace evit
