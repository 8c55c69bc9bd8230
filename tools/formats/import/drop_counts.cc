#include "tools/formats/import/drop_counts.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace evit::formats {

std::string DropText(const DropCounts& dropped, const std::string& what) {
  std::string sorted =
      dropped.sorted > 0 ? std::to_string(dropped.sorted) + " " + what + " put into order of time" : "";
  if (dropped.cut_off)
    sorted += std::string(sorted.empty() ? "" : "; ") + "the file of the " + what +
              " is cut off: what follows its last whole packet is missing" +
              (dropped.lost_share > 0
                   ? " (" + std::to_string(std::lround(100 * dropped.lost_share)) + " % of the file)"
                   : "") +
              "; copy it again if there is more";
  if (dropped.total() == 0) return sorted;
  std::string reasons;
  for (const auto& [count, reason] :
       {std::pair(dropped.late, "not later than the one before, or by more than 50 ms late"),
        std::pair(dropped.outlier, "with a time far ahead of those that follow"),
        std::pair(dropped.invalid, "not a number, or no rotation"),
        std::pair(dropped.outside, "outside the sensor (is the image size right?)"),
        std::pair(dropped.unstamped, "before the stream's first time stamp")}) {
    if (count > 0) reasons += (reasons.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
  }
  return std::to_string(dropped.total()) + " " + what + " dropped: " + reasons +
         (sorted.empty() ? "" : "; " + sorted);
}

void RequireMostKept(const std::string& name, const DropCounts& dropped, std::int64_t kept,
                     const std::string& what) {
  constexpr std::int64_t kFew = 10, kShare = 20;  // at most one in 20
  constexpr std::int64_t kTelling = 1000;         // events
  const std::int64_t n = dropped.total();
  if (dropped.from_one && n + kept >= kTelling)
    throw std::runtime_error(name + ": columns and rows seem to be counted from 1: none is 0, and " +
                             std::to_string(dropped.outside) +
                             " lie one beyond the sensor; EVIT counts from 0: subtract 1 from both, or give "
                             "--size if the sensor is larger");
  if (n == 0) return;
  if (n <= kFew ? n < kept : kShare * n <= n + kept) return;
  const bool order = 2 * (dropped.late + dropped.outlier) > n;
  throw std::runtime_error(
      name + ": " + DropText(dropped, what) + ", of " + std::to_string(n + kept) +
      ": more than 5 % would be missing" +
      (order ? "; sort the recording by time, or import each part of it separately" : ""));
}

void AppendPose(StampedPose pose, bool finite, Trajectory* truth, DropCounts* dropped) {
  const double norm = pose.pose.q.norm();
  const bool valid = finite && pose.pose.p.allFinite() && std::abs(norm - 1) < 1e-2;  // false of NaN
  if (valid) pose.pose.q.normalize();
  AppendValid(pose, valid, truth, dropped);
}

}  // namespace evit::formats
