#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/tracking/anchor.h"
#include "common/tracking/start_search.h"
#include "common/tracking/tracker_options.h"
#include "common/tracking/visual_inertial_alignment.h"

namespace evit {

/// The frames of a start, each localised by its events from the one before, and what they prove: a single
/// frame finds some minimum nearly anywhere, several in a row that agree do not. Besides, no other pose
/// around may explain the events as well.
class StartChain {
 public:
  struct Frame {
    BootstrapFrame frame;
    std::int64_t seq = 0;
    double significance = 0;
    int n_events = 0;
    std::shared_ptr<const SurfaceField> field;  // as far as the caller wants it back
    AlignmentPoints points;                     // the same
  };

  StartChain(const TrackerOptions& options, const AlignmentSettings& alignment)
      : options_(options.bootstrap),
        min_events_(options.min_events),
        by_gyro_(!options.event_only),
        alignment_(alignment) {}

  /// The body is here, to some centimetres and degrees. Velocity zero: unknown.
  void Start(const BodyState& state);

  /// A frame of time `t` (us) comes, whether it fits or not: from the first on the start pose grows old.
  void Begin(Utime t);
  /// Localised from the frame before, if there is one.
  void Add(Frame frame);
  /// A frame did not fit: those so far count no more.
  void Break();

  enum class Verdict {
    kUnsure,     // perhaps it fits by chance
    kFalse,      // it has been unsure for too long
    kElsewhere,  // another pose explains the newest frame better: it has started again there
    kFound,      // the frames agree, and no other pose explains them as well
    kDoubted,    // the same, but another one explains the newest as well
    kProven      // found, with as much motion or time as a start needs
  };
  /// After Add(), by the newest frame's events. From kFound on the anchor is at the newest frame.
  Verdict Judge(const SurfaceField& field, const AlignmentPoints& points);

  /// The older half of the frames counts no more.
  void DropHalf();
  /// All frames, oldest first; none is left.
  std::vector<Frame> Take();

  /// Consecutive, no gaps.
  const std::vector<Frame>& frames() const { return frames_; }
  /// m/s, map frame.
  Eigen::Vector3d RecentVelocity() const;

  /// Where the map is looked for.
  const Anchor& anchor() const { return anchor_; }
  Anchor* mutable_anchor() { return &anchor_; }

 private:
  void Restart(const BodyState& state);
  double MeanSignificance() const;
  double StartError() const;
  bool HasMoved() const;
  bool HasSeenEnough() const;
  bool Agrees() const;
  Verdict LookForRivals(const SurfaceField& field, const AlignmentPoints& points);
  Verdict RuleOutRivals(const SurfaceField& field, const AlignmentPoints& points);

  BootstrapOptions options_;
  int min_events_;
  bool by_gyro_;  // each frame is predicted by the gyro, which contradicts a false chain that moves
  AlignmentSettings alignment_;
  Anchor anchor_;
  std::vector<Frame> frames_;
  bool unrivaled_ = false;      // this chain: no other pose explains the events as well
  int n_clear_ = 0;             // searches in a row that have found no such pose, until it is unrivaled
  std::int64_t looked_at_ = 0;  // number of the frame in which rivals were looked for last
  // How wrong the start pose was, in ranges of a start search, at least 1: by this chain, and at least by the
  // rivals that chains have been given up for.
  double start_error_ = 1, least_start_error_ = 1;
  Utime anchored_at_ = 0;  // us: of the first frame after the anchor's start; 0: there was none
  // When this chain began (us) and where, seen from the anchor: m (map frame), rad, and s since its start.
  struct {
    Utime t = 0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    double rotation = 0, seconds = 0;
  } begin_;
};

}  // namespace evit
