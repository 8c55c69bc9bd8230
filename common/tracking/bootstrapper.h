#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "common/geometry/rig.h"
#include "common/tracking/anchor.h"
#include "common/tracking/keyframe_input.h"
#include "common/tracking/point_selector.h"
#include "common/tracking/sliding_window.h"
#include "common/tracking/start_search.h"
#include "common/tracking/visual_inertial_alignment.h"

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
  struct LocalizedFrame {  // kept until the window takes over
    BootstrapFrame frame;
    std::int64_t seq;
    std::shared_ptr<const SurfaceField> field;
    AlignmentPoints points;
    double significance;
    int n_events;
  };

  void Restart(const BodyState& state);
  double MeanSignificance() const;
  void BeginChain(Utime t);
  double StartError() const;
  void RejectFrame(Result* result);
  Eigen::Vector3d RecentVelocity() const;
  bool HasMoved() const;
  bool ReadyToAlign() const;
  bool Found() const;
  bool RuleOutRivals(Result* result);
  void Align(Result* result);

  Rig rig_;
  TrackerOptions options_;
  AlignmentSettings alignment_;
  const PointSelector* points_;
  BodyState state_;
  Anchor anchor_;
  int rejected_ = 0;                    // frames in a row, or since the map was last found
  std::vector<LocalizedFrame> frames_;  // consecutive, no gaps
  bool unrivaled_ = false;              // this chain: no other pose explains the events as well
  std::int64_t looked_at_ = 0;          // number of the frame in which rivals were looked for last
  // How wrong the start pose was, in ranges of a start search, at least 1: by this chain, and at least by the
  // rivals that chains have been given up for.
  double start_error_ = 1, least_start_error_ = 1;
  Utime anchored_at_ = 0;  // us: of the first frame after the anchor's start; 0: there was none
  // When this chain began (us) and where, seen from the anchor: m (map frame), rad, and s since its start.
  struct {
    Utime t = 0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    double rotation = 0, seconds = 0;
  } chain_begin_;
};

}  // namespace evit
