#include "common/evaluation/trajectory_pairs.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace evit {
namespace {

constexpr Utime kUsualHole = 200'000, kLongestHole = 1'000'000;  // us

// The usual distance of two poses; 0 where there are not two.
Utime MedianStep(const Trajectory& trajectory) {
  std::vector<Utime> steps;
  for (std::size_t k = 1; k < trajectory.size(); ++k) steps.push_back(trajectory[k].t - trajectory[k - 1].t);
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

bool TruthIsSparse(const Trajectory& truth, const Trajectory& estimate) {
  const Utime step = MedianStep(truth);
  return step > kDenseTruth && step > MedianStep(estimate);
}

}  // namespace

Utime MaxHole(const Trajectory& trajectory) {
  return std::clamp<Utime>(MedianStep(trajectory) * 3 / 2, kUsualHole, kLongestHole);
}

std::vector<TrajectoryPair> MakePairs(const Trajectory& truth, const Trajectory& estimate) {
  const bool sparse = TruthIsSparse(truth, estimate);
  const Trajectory& at_stamps_of = sparse ? truth : estimate;
  const Trajectory& interpolated = sparse ? estimate : truth;
  const Utime hole = MaxHole(interpolated);
  std::vector<TrajectoryPair> pairs;
  for (const StampedPose& s : at_stamps_of) {
    SE3 at;
    if (!PoseAt(interpolated, s.t, &at, hole)) continue;
    pairs.push_back(sparse ? TrajectoryPair{s.t, s.pose, at} : TrajectoryPair{s.t, at, s.pose});
  }
  return pairs;
}

std::string UnscoredText(const Trajectory& truth, const Trajectory& estimate) {
  if (truth.empty() || estimate.empty()) return "";
  char text[200] = "";
  if (TruthIsSparse(truth, estimate)) {
    const std::size_t n = MakePairs(truth, estimate).size();
    std::snprintf(text, sizeof text, "truth only every %.2f s: scored at its own %zu stamps, of %zu",
                  ToSeconds(MedianStep(truth)), n, truth.size());
    return text;
  }
  const Utime hole = MaxHole(truth);
  std::size_t before = 0, after = 0, holes = 0;
  for (const StampedPose& s : estimate) {
    SE3 at;
    if (PoseAt(truth, s.t, &at, hole)) continue;
    ++(s.t < truth.front().t ? before : s.t > truth.back().t ? after : holes);
  }
  if (before + after + holes == 0) return "";
  std::snprintf(text, sizeof text, "%zu poses not scored:", before + after + holes);
  std::string sentence = text;
  const char* gap = " ";
  const auto add = [&](std::size_t n, const char* why) {
    if (n == 0) return;
    sentence += gap + std::to_string(n) + why;
    gap = ", ";
  };
  add(before, " before the truth begins");
  add(after, " after it ends");
  std::snprintf(text, sizeof text, " in holes of the truth longer than %.2f s", ToSeconds(hole));
  add(holes, text);
  return sentence;
}

std::string TooFewPairsText(const Trajectory& truth, const Trajectory& estimate) {
  const std::size_t n = MakePairs(truth, estimate).size();
  const bool apart = truth.empty() || estimate.empty() || estimate.back().t < truth.front().t ||
                     estimate.front().t > truth.back().t;
  if (apart) return "truth and estimate do not overlap in time; are they from the same sequence and clock?";
  const std::string why = UnscoredText(truth, estimate);
  return "only " + std::to_string(n) + " pairs of truth and estimate, too few for a score" +
         (why.empty() ? "" : "; " + why);
}

}  // namespace evit
