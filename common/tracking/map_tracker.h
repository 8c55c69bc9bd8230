#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/geometry/rig.h"
#include "common/map/map_index.h"
#include "common/tracking/keyframe_input.h"
#include "common/tracking/tracker_options.h"
#include "common/tracking/tracker_output.h"

namespace evit {

struct PlacePrior;
struct PlaceQuery;
struct PlaceCandidate;

/// Tracks a body in a semi-dense map, keyframe by keyframe. Knows nothing of where keyframes and map points
/// come from: before each keyframe it says which view of the map it needs.
class MapTracker {
 public:
  virtual ~MapTracker() = default;

  /// Starts over: the body is here, to some centimetres and degrees.
  virtual void Start(const SE3& T_map_body) = 0;
  /// The same with velocity (zero: unknown) and biases, which are trusted.
  virtual void Start(const BodyState& state) = 0;
  /// Continues where another tracker was after its keyframe of time `t` (us), as though it were the same
  /// tracker: `information` is TrackerOutput's. The next keyframe must follow that one.
  virtual void Start(Utime t, const BodyState& state, const Matrix15d& information) = 0;

  /// The view whose points the next keyframe needs.
  virtual VisibilityQuery NextQuery() const = 0;
  /// The same for the keyframe after this one, before it is processed: from its IMU samples, so that the
  /// answer comes while it is being processed. For use while tracking.
  virtual VisibilityQuery QueryAfter(const KeyframeInput& keyframe) const = 0;
  /// What to ask for where that view needs points that are not there yet: a view farther along the motion,
  /// whose points serve both, and for longer.
  virtual VisibilityQuery QueryBeyond(const KeyframeInput& keyframe) const { return QueryAfter(keyframe); }
  /// Whether the points of `answered`, the query answered last, serve `query` as well, so that it need not be
  /// asked. While tracking only.
  virtual bool Suffices(const VisibilityQuery& /*answered*/, const VisibilityQuery& /*query*/) const {
    return false;
  }
  /// The answer to one of these queries. ids: indices into the map; points: map frame, m.
  virtual void AddVisible(const std::vector<std::int32_t>& ids,
                          const std::vector<Eigen::Vector3f>& points) = 0;
  /// Forgets all points: what comes next is another map's.
  virtual void ForgetPoints() = 0;

  virtual TrackerOutput Process(const KeyframeInput& keyframe) = 0;

  /// What a tracker without a pose asks the map (common/localization): null where it asks nothing, as most
  /// do.
  virtual const PlaceQuery* PlaceQuestion() const { return nullptr; }
  /// The answer.
  virtual void AddPlaces(const std::vector<PlaceCandidate>& /*places*/) {}
  /// What is known of the place by other means; replaces what was known before.
  virtual void SetPlacePrior(const PlacePrior& /*prior*/) {}

  /// Overload: use only this fraction (0..1] of the configured points, and stop a solve after `seconds`
  /// with the best state so far (0: never). Neither is reproducible: for real time only.
  virtual void set_point_share(double share) = 0;
  virtual void set_solve_budget(double seconds) = 0;

  virtual TrackerMode mode() const = 0;
  /// Newest estimate: where IMU-rate poses are propagated from.
  virtual const BodyState& state() const = 0;
  /// Of the newest keyframe, us; 0 before the first.
  virtual Utime state_time() const = 0;
  /// Angular rate of the body, rad/s, body frame.
  virtual const Eigen::Vector3d& rate() const = 0;
};

/// EventOnlyTracker where the options say so, else Tracker. `T_map_body`: pose at the first keyframe, to some
/// centimetres and degrees.
std::unique_ptr<MapTracker> MakeTracker(const Rig& rig, const TrackerOptions& options, const SE3& T_map_body);

}  // namespace evit
