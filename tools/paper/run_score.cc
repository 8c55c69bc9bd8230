#include "tools/paper/run_score.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "common/geometry/degrees.h"
#include "tools/run/report.pb.h"

namespace evit::paper {
namespace {

report::Report ReadReport(const std::string& folder) {
  const std::string path = folder + "/report.json";
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  report::Report report;
  if (!file || !google::protobuf::util::JsonStringToMessage(text, &report).ok()) {
    throw std::runtime_error(path + ": is not a report of `evit run`; delete its folder and run again");
  }
  return report;
}

Trajectory Until(Trajectory trajectory, std::optional<Utime> end) {
  if (!end) return trajectory;
  trajectory.erase(
      std::remove_if(trajectory.begin(), trajectory.end(), [&](const StampedPose& s) { return s.t >= *end; }),
      trajectory.end());
  return trajectory;
}

// Empty when nothing was tracked: ReadTum() treats a file without poses as an error.
Trajectory ReadEstimate(const std::string& folder, const report::Report& report) {
  return report.poses() == 0 ? Trajectory() : ReadTum(folder + "/trajectory.tum");
}

// Only after the first pose: a start that takes several attempts does not count as lost.
std::optional<Utime> FirstLoss(const report::Report& report, const Trajectory& estimate, std::string* why) {
  for (const report::ModeChange& change : report.mode_changes()) {
    const auto t = static_cast<Utime>(change.utime());
    if (change.mode() != "LOST" || estimate.empty() || t <= estimate.front().t) continue;
    char text[40];
    std::snprintf(text, sizeof text, "after %.2f s: ", 1e-6 * (change.utime() - report.begin_utime()));
    *why = text + change.reason();
    return t;
  }
  return {};
}

struct AlignmentNames {
  Alignment alignment;
  const char *id, *text;
};
constexpr AlignmentNames kNames[] = {
    {Alignment::kFirstPair, "first_pair", "aligned by the first pair of poses, as in the paper"},
    {Alignment::kUmeyama, "umeyama", "aligned by SE(3) over all poses (Umeyama, without scale)"},
    {Alignment::kNone, "none", "not aligned (map frame)"}};

const AlignmentNames& NamesOf(Alignment alignment) {
  return *std::find_if(std::begin(kNames), std::end(kNames),
                       [&](const AlignmentNames& names) { return names.alignment == alignment; });
}

}  // namespace

std::size_t AlignmentIndex(Alignment alignment) {
  return std::find(kAlignments.begin(), kAlignments.end(), alignment) - kAlignments.begin();
}

const char* AlignmentId(Alignment alignment) { return NamesOf(alignment).id; }
const char* AlignmentText(Alignment alignment) { return NamesOf(alignment).text; }

RunScore ScoreTrajectory(const Trajectory& truth, const Trajectory& estimate, std::optional<Utime> lost_at) {
  const Trajectory tracked = Until(estimate, lost_at);
  RunScore score;
  for (std::size_t a = 0; a < kAlignments.size(); ++a) {
    for (std::size_t m = 0; m < kMilestones.size(); ++m) {
      const TrajectoryError e = MilestoneError(truth, tracked, kAlignments[a], kMilestones[m]);
      if (e.scored() && e.oriented)
        score.ate[a][m] = Ate{100 * e.position_rmse, kDegreesPerRadian * e.orientation_rmse};
    }
  }
  score.tracked = AbsoluteError(truth, tracked, Alignment::kNone).reached;
  if (tracked.size() > 1) {
    score.keyframe_rate_hz =
        static_cast<double>(tracked.size() - 1) / ToSeconds(tracked.back().t - tracked.front().t);
  }
  return score;
}

RunScore ScoreRun(const std::string& folder, const std::string& truth_file) {
  const report::Report report = ReadReport(folder);
  const Trajectory estimate = ReadEstimate(folder, report);
  Trajectory truth;
  for (const StampedPose& s : ReadTum(truth_file)) {
    if (static_cast<double>(s.t) >= report.begin_utime() && static_cast<double>(s.t) <= report.end_utime())
      truth.push_back(s);
  }
  std::string lost;
  const std::optional<Utime> loss = FirstLoss(report, estimate, &lost);
  RunScore score = ScoreTrajectory(truth, estimate, loss);
  score.lost = estimate.empty() ? "no pose at all" : lost;
  double cpu = 0;
  for (const report::Service& service : report.services()) cpu += service.cpu_s();
  if (report.sequence_s() > 0) score.cpu_s_per_s = cpu / report.sequence_s();
  return score;
}

Trajectory TrackedPart(const std::string& folder) {
  const report::Report report = ReadReport(folder);
  const Trajectory estimate = ReadEstimate(folder, report);
  std::string lost;
  return Until(estimate, FirstLoss(report, estimate, &lost));
}

}  // namespace evit::paper
