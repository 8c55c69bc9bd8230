#pragma once

#include <string>

#include "common/time/utime.h"

namespace evit {

/// A start that looked right may be a false one: during the first second the events tell. Later the IMU
/// confirms the pose, and events may say little for a while, as where half of the map is missing.
class StartProbation {
 public:
  /// Bootstrapping ended at `t`, us.
  void Begin(Utime t);
  /// The state is known otherwise: nothing is to be proved.
  void Skip();

  /// How well the map lies on a keyframe that has events (AlignmentSignificance).
  void Add(double significance);

  /// Why the start is a false one, seen at `t` (us); empty while it may be right.
  std::string WhyFalse(Utime t) const;
  /// Whether it has turned out to be right: once five keyframes fitted.
  bool Passed() const { return passed_; }

 private:
  Utime began_ = 0;               // us; 0: skipped
  double mean_significance_ = 0;  // of the last ten keyframes or so
  int n_ = 0;                     // averaged in it
  bool passed_ = false;
};

}  // namespace evit
