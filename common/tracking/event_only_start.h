#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/tracking/keyframe_input.h"
#include "common/tracking/point_selector.h"
#include "common/tracking/start_chain.h"
#include "common/tracking/tracker_output.h"

namespace evit {

/// The start of event-only tracking, as EVIT's but for the IMU (Bootstrapper): where the body is in the first
/// frame, and whether the frames that follow prove it (StartChain). Frames nearer than kApart to each other
/// show mostly the same events: of those one counts.
class EventOnlyStart {
 public:
  static constexpr Utime kApart = 9'000;  // us: of 300 Hz each third, of 100 Hz each frame

  /// `points` must outlive this.
  EventOnlyStart(const TrackerOptions& options, const AlignmentSettings& alignment,
                 const PointSelector* points)
      : options_(options), alignment_(alignment), points_(points), chain_(options, alignment) {}

  /// Looks for the map around this pose.
  void Begin(const SE3& T_map_body);

  /// The first frame of a chain: the best pose of a wide search. Nothing where the frame is too near to the
  /// one before, or the map does not lie on it. `field`: of kStartRange's levels. `out` receives quality and
  /// iterations.
  std::optional<LocalizerResult> Search(const KeyframeInput& keyframe, const SurfaceField& field,
                                        TrackerOutput* out);

  enum class Status {
    kUnsure,     // it is not known whether the pose is right
    kElsewhere,  // it is not: search again
    kFound,      // it is most likely: poses are worth reporting
    kProven      // it is
  };
  /// A frame whose events lie on `points` of the map at T_map_body, localised from the frame before.
  Status Follow(const KeyframeInput& keyframe, const SurfaceField& field, const AlignmentPoints& points,
                const SE3& T_map_body, double significance);
  /// A frame whose events do not lie on the map: search again, but for one among others.
  Status FollowNothing(Utime t);

  /// Where the body was taken to be last, before what has proved nothing.
  const SE3& pose() const { return chain_.anchor().pose(); }
  /// Whether it has searched in vain for long.
  bool hopeless() const;
  /// For a person.
  std::string reason() const;

 private:
  void Reject();

  TrackerOptions options_;
  AlignmentSettings alignment_;
  const PointSelector* points_;
  StartChain chain_;
  Status status_ = Status::kUnsure;
  Utime looked_at_ = 0;  // us: newest frame that counted; 0: none
  Utime fitted_at_ = 0;  // us: newest frame that the map lay on
  std::int64_t n_counted_ = 0;
  int n_events_ = 0;  // since the newest frame that counted
  int rejected_ = 0;  // frames in a row, or since the map was last found
  bool sees_map_ = true;
};

}  // namespace evit
