#include "tools/monitor/known_poses.h"

#include <cstdlib>

#include "common/wire/geometry_wire.h"

namespace evit::monitor {
namespace {

constexpr Utime kBin = 100'000;       // us
constexpr Utime kFarthest = 300'000;  // us: a hand moves some centimetres in that time

}  // namespace

void KnownPoses::OnWindow(const window_state_t& window, double /*latency_ms*/) {
  if (window.mode != tracker_mode_t::TRACKING || window.node.empty()) return;
  const node_state_t& newest = window.node.back();
  const auto bin = newest.utime / kBin;
  if (poses_.size() >= kMost && poses_.count(bin) == 0) return;
  poses_[bin] = {newest.utime, PoseOf(newest)};
}

std::optional<SE3> KnownPoses::At(Utime t) const {
  std::optional<SE3> nearest;
  Utime distance = kFarthest;
  const auto after = poses_.lower_bound(t / kBin - kFarthest / kBin);
  for (auto it = after; it != poses_.end() && it->second.t <= t + kFarthest; ++it) {
    const Utime away = std::abs(it->second.t - t);
    if (away > distance) continue;
    distance = away;
    nearest = it->second.T_map_body;
  }
  return nearest;
}

}  // namespace evit::monitor
