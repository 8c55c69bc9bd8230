#include "tools/formats/import/drop_counts.h"

#include <cmath>
#include <utility>

namespace evit::formats {

std::string DropText(const DropCounts& dropped, const std::string& what) {
  if (dropped.total() == 0) return "";
  std::string reasons;
  for (const auto& [count, reason] :
       {std::pair(dropped.disorder, "not later than the one before"),
        std::pair(dropped.invalid, "not a number, or no rotation"),
        std::pair(dropped.outside, "outside the sensor (is the image size right?)"),
        std::pair(dropped.unstamped, "before the stream's first time stamp")}) {
    if (count > 0) reasons += (reasons.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
  }
  return std::to_string(dropped.total()) + " " + what + " dropped: " + reasons;
}

void AppendPose(StampedPose pose, bool finite, Trajectory* truth, DropCounts* dropped) {
  const double norm = pose.pose.q.norm();
  const bool valid = finite && pose.pose.p.allFinite() && std::abs(norm - 1) < 1e-2;  // false of NaN
  if (valid) pose.pose.q.normalize();
  AppendValid(pose, valid, truth, dropped);
}

}  // namespace evit::formats
