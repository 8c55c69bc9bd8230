#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "common/tracking/chain_solver.h"
#include "common/tracking/prior.h"
#include "common/tracking/tracker_options.h"

namespace evit {

/// A keyframe's alignment term around the pose where it was last evaluated.
struct LocalAlignment {
  bool known = false;
  SE3 T_map_body;
  AlignmentTerm term;
  Matrix6d bend = Matrix6d::Zero();  // see EvaluateAlignmentExactly()
};

/// One keyframe in the window.
struct WindowNode {
  Utime t = 0;           // us
  std::int64_t seq = 0;  // keyframe number
  BodyState state;
  std::shared_ptr<const SurfaceField> field;
  AlignmentPoints points;               // of the map, in view of this keyframe
  std::shared_ptr<Preintegration> imu;  // from the previous node to this one; unused in the oldest
  bool stood_still = false;             // since the previous node
  AlignmentTerm alignment = {};         // as of its first solve; cost 0: not yet known
  LocalAlignment local = {};            // the solver's
};

/// Joint optimisation of the last N keyframes (paper Sec. III-D): event alignment in each, IMU terms between
/// neighbours, and where the body stood still that it did.
class SlidingWindow {
 public:
  struct Summary {
    int iterations = 0;
    bool usable = false;  // the solver reached a finite state
  };

  SlidingWindow(AlignmentSettings alignment, double gravity, const WindowOptions& options);

  /// Starts with these nodes, oldest first. `prior`: on the first of them (FirstNode::kPrior only).
  void Start(std::deque<WindowNode> nodes, const StatePrior& prior);

  /// Adds the newest node, whose state is a prediction. Where the window is full the oldest leaves: with
  /// FirstNode::kPrior what it knew stays as a prior on the next.
  void Push(WindowNode node);

  Summary Solve();
  /// Takes back what Solve() made of the newest node's surface: it keeps its IMU term alone, and all states
  /// are `states`, those before Solve(), oldest first.
  void DropNewestAlignment(const std::vector<BodyState>& states);
  /// Says that the body stood still between the newest two nodes, and solves again.
  Summary HoldNewest();
  /// Solve() stops after so long with the best states so far; 0: never.
  void set_time_budget(double seconds) { time_budget_ = seconds; }

  const std::deque<WindowNode>& nodes() const { return nodes_; }

  /// All that is known of the newest state: inverse covariance over its tangent.
  Matrix15d NewestInformation() const;

 private:
  KeyframeLink Link(const WindowNode& node) const;
  /// Prior on nodes_[n + 1] from everything up to nodes_[n], given the prior on nodes_[n].
  StatePrior Eliminate(const StatePrior& prior, const AlignmentTerm& alignment, std::size_t n) const;
  /// The node's alignment term for the solver, with the node at this pose.
  AlignmentTerm AlignNear(const SE3& T_map_body, WindowNode* node) const;
  ChainModel ModelAt(const std::vector<BodyState>& states, const std::vector<KeyframeLink>& links);

  AlignmentSettings alignment_;
  double gravity_;
  WindowOptions options_;
  std::deque<WindowNode> nodes_;
  StatePrior prior_;
  double time_budget_ = 0;  // s
};

}  // namespace evit
