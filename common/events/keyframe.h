#pragma once

#include <cstdint>
#include <vector>

#include "common/imu/imu_sample.h"

namespace evit {

/// One keyframe: the image at its stamp and the IMU samples since the one before (see keyframe_t).
struct Keyframe {
  enum class Encoding {
    kTimeSurface = 0,  // negated: 0 (event just now) .. 255 (none)
    kEventCount = 1    // 128 + events brighter - events darker, limited to 1..255 (EVPT)
  };
  using Image = std::vector<std::uint8_t>;  // row-major [height][width]

  Utime utime = 0;
  std::int64_t seq = 0;
  Utime previous_utime = 0;  // utime itself where there is no keyframe before
  bool high_rate = false;
  std::int64_t n_events = 0;  // since the keyframe before
  double decay_us = 0;
  Utime lookahead = 0;   // us: events up to utime + this count
  Utime from_utime = 0;  // us: kEventCount: events after this count
  int width = 0, height = 0;
  Encoding encoding = Encoding::kTimeSurface;
  Image surface;
  std::vector<ImuSample> imu;  // from previous_utime to utime, both interpolated where needed; empty if first
  Utime imu_gap = 0;           // us: longest distance between two raw samples of the interval

  double update_ms = 0, render_ms = 0;  // how long making it took
};

}  // namespace evit
