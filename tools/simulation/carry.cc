#include "tools/simulation/carry.h"

#include <algorithm>

#include "common/geometry/so3.h"

namespace evit::simulation {

void CarryAway(const Carry& carry, Utime begin, Trajectory* poses) {
  if (!carry.any() || poses->empty()) return;
  const auto from = static_cast<double>(begin) + 1e6 * carry.from_s;
  const auto first_carried = std::find_if(poses->begin(), poses->end(), [&](const StampedPose& pose) {
    return static_cast<double>(pose.t) >= from;
  });
  if (first_carried == poses->end()) return;
  const Eigen::Vector3d pivot = first_carried->pose.p;
  for (auto it = first_carried; it != poses->end(); ++it) {
    const double u = std::min(1.0, (static_cast<double>(it->t) - from) / (1e6 * (carry.to_s - carry.from_s)));
    const double share = u * u * u * (10 + u * (6 * u - 15));
    const Eigen::Quaterniond turn = ExpSO3({0, 0, share * carry.yaw});
    it->pose.p = pivot + turn * (it->pose.p - pivot) + share * Eigen::Vector3d(carry.dx, carry.dy, 0);
    it->pose.q = (turn * it->pose.q).normalized();
  }
}

}  // namespace evit::simulation
