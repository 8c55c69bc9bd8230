#include "services/window_optimizer/merge_imu.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace evit {

void MergeImu(const keyframe_t& before, keyframe_t* after) {
  constexpr int kMost = 4000;  // samples: 20 s at 200 Hz, more than the tracker bridges
  const bool neighbours = before.epoch == after->epoch && before.utime == after->previous_utime &&
                          before.n_imu >= 2 && after->n_imu >= 2 &&
                          before.imu_utime.back() == after->imu_utime.front();
  if (!neighbours || before.n_imu + after->n_imu > kMost) return;
  after->previous_utime = before.previous_utime;
  after->n_events += std::min(before.n_events, std::numeric_limits<std::int32_t>::max() - after->n_events);
  after->imu_gap_us = std::max(after->imu_gap_us, before.imu_gap_us);
  // The last sample of one interval is the first of the next.
  const auto put_before = [](const auto& first, auto* second) {
    second->insert(second->begin(), first.begin(), first.end() - 1);
  };
  put_before(before.imu_utime, &after->imu_utime);
  put_before(before.gyro, &after->gyro);
  put_before(before.accel, &after->accel);
  after->n_imu = static_cast<std::int32_t>(after->imu_utime.size());
}

}  // namespace evit
