#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "common/evaluation/trajectory_error.h"

namespace evit::paper {

/// The paper's milestones (Sec. IV): shares of a sequence.
inline constexpr std::array<double, 3> kMilestones{0.3, 0.5, 1.0};
/// How trajectories are aligned: the paper's way first.
inline constexpr std::array<Alignment, 3> kAlignments{Alignment::kFirstPair, Alignment::kUmeyama,
                                                      Alignment::kNone};
/// Its place in kAlignments.
std::size_t AlignmentIndex(Alignment alignment);
/// For file names ("first_pair"), and for people.
const char* AlignmentId(Alignment alignment);
const char* AlignmentText(Alignment alignment);

/// RMSE of one trajectory up to a milestone.
struct Ate {
  double position_cm = 0, orientation_deg = 0;
};

/// What one run of one method on one recording gave.
struct RunScore {
  /// By alignment and milestone, in the order above; nothing where the milestone was not reached.
  std::array<std::array<std::optional<Ate>, kMilestones.size()>, kAlignments.size()> ate;
  double keyframe_rate_hz = 0;  // of what it tracked
  double cpu_s_per_s = 0;       // all services, per second of the sequence
  double tracked = 0;           // 0..1 of the sequence, until lost for the first time
  std::string lost;             // why and when it was lost; empty: never
};

/// Scores `estimate` up to `lost_at` (first loss of track; nothing: never): as in the paper a method that is
/// lost has ended, even where it would find itself again. `truth`: of the sequence's span, body in the map
/// frame.
RunScore ScoreTrajectory(const Trajectory& truth, const Trajectory& estimate, std::optional<Utime> lost_at);

/// Reads what `evit run` left in `folder` and scores it against the TUM file `truth`. Throws
/// std::runtime_error naming the file.
RunScore ScoreRun(const std::string& folder, const std::string& truth);

/// The trajectory of such a run, up to its first loss.
Trajectory TrackedPart(const std::string& folder);

}  // namespace evit::paper
