#pragma once

#include "common/evaluation/trajectory.h"

namespace evit {

enum class Alignment {
  kNone,       // map frame as it is
  kFirstPair,  // SE(3) of the first pair (the paper's protocol)
  kUmeyama,    // least-squares SE(3) over all pairs (no scale)
  kScaled,     // the same with a scale, Sim(3): what is left of the error where the map's scale is off
};

/// Absolute trajectory error over the pairs of MakePairs (common/evaluation/trajectory_pairs.h). Where stamps
/// are equal, so that nothing is interpolated, the figures are those of evo (APE of translation and of the
/// rotation's angle; RPE over all pairs): evo_definitions.py.
struct TrajectoryError {
  int n_pairs = 0;
  double position_rmse = 0;     // m
  double orientation_rmse = 0;  // rad
  double position_max = 0;      // m
  double orientation_max = 0;   // rad
  double reached = 0;           // 0..1: share of the truth's time span that lies before the last pose
  bool scaled = true;           // false: positions on one spot do not say which scale (Alignment::kScaled)
  // False: positions on a straight line, or on one spot, leave the turn of an alignment by positions open.
  // What is left of the position error is still one figure; an orientation error there is none.
  bool oriented = true;

  /// Whether the position's figures mean something: enough pairs, and an alignment that these determine.
  bool scored() const { return n_pairs >= kMinPairs && scaled; }
  static constexpr int kMinPairs = 3;
  static constexpr double kMinSpread = 0.01;  // m, rms: positions that spread by less do not tell a turn
};
TrajectoryError AbsoluteError(const Trajectory& truth, const Trajectory& estimate, Alignment alignment);

/// The same over the first `share` (0..1) of the truth's time span; n_pairs == 0 where the estimate ends
/// before it (milestones 30 / 50 / 100 % of the paper's tables).
TrajectoryError MilestoneError(const Trajectory& truth, const Trajectory& estimate, Alignment alignment,
                               double share);

/// Relative pose error over intervals of `delta` us: RMSE of position (m) and orientation (rad).
TrajectoryError RelativeError(const Trajectory& truth, const Trajectory& estimate, Utime delta);

}  // namespace evit
