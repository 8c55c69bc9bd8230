#pragma once

#include <deque>
#include <string>

#include "common/geometry/rig.h"
#include "common/tracking/keyframe_input.h"
#include "common/tracking/point_selector.h"
#include "common/tracking/sliding_window.h"
#include "common/tracking/start_chain.h"

namespace evit {

/// The start, and the way back after a loss (paper Sec. III-C): high-rate frames are localised by their
/// events alone, each from the one before, until velocities and biases can be solved for.
class Bootstrapper {
 public:
  /// `points` must outlive this.
  Bootstrapper(const Rig& rig, const TrackerOptions& options, const AlignmentSettings& alignment,
               const PointSelector* points);

  /// Looks for the map around this state. Velocity zero: unknown. The biases are trusted.
  void Start(const BodyState& state);

  struct Result {
    enum class Status {
      kRejected,   // the map does not align with this frame's events
      kHopeless,   // no frame has aligned for a long time
      kUnsure,     // this frame aligns, but perhaps by chance
      kLocalized,  // several frames in a row align and agree with each other
      kAligned     // velocities and biases are known too: the sliding window starts with `window`
    };
    Status status = Status::kRejected;
    std::string reason;      // for a person
    AlignmentPoints points;  // of the map, that the frame was aligned with
    AlignmentQuality quality;
    int iterations = 0;
    std::deque<WindowNode> window;
    StatePrior prior;  // on the first of these
  };
  /// `follows`: the frame's IMU samples tell how the body moved since the frame before. `rate`: rad/s, body
  /// frame.
  Result Process(const KeyframeInput& keyframe, bool follows, const Eigen::Vector3d& rate);

  /// Newest estimate. While frames are rejected: the anchor.
  const BodyState& state() const { return state_; }

 private:
  void RejectFrame(Result* result);
  void Judge(const SurfaceField& field, Result* result);
  void Align(Result* result);

  Rig rig_;
  TrackerOptions options_;
  AlignmentSettings alignment_;
  const PointSelector* points_;
  BodyState state_;
  StartChain chain_;
  int rejected_ = 0;  // frames in a row, or since the map was last found
};

}  // namespace evit
