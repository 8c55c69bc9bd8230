#pragma once

#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"

namespace evit {

/// Truth and estimate at one time.
struct TrajectoryPair {
  Utime t;
  SE3 truth, estimate;
};

/// Truth that comes at least this often (us) is interpolated at the estimate's stamps.
inline constexpr Utime kDenseTruth = 50'000;

/// One pair for each pose of the estimate, the truth interpolated. Where the truth is sparser than
/// kDenseTruth and than the estimate, one for each pose of the truth instead, the estimate interpolated: a
/// line between two poses a quarter of a second apart is not truth. What is interpolated may have holes of
/// one and a half times its own usual step, at least 0.2 s, at most 1 s.
std::vector<TrajectoryPair> MakePairs(const Trajectory& truth, const Trajectory& estimate);

/// The longest hole (us) that MakePairs interpolates over in this trajectory.
Utime MaxHole(const Trajectory& trajectory);

/// How many poses of the estimate have no truth, and why, as a sentence; empty where all have.
std::string UnscoredText(const Trajectory& truth, const Trajectory& estimate);

/// Why there are too few pairs for a score, as a sentence.
std::string TooFewPairsText(const Trajectory& truth, const Trajectory& estimate);

}  // namespace evit
