#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "common/time/utime.h"

namespace evit::monitor {

/// How long after its instant a result comes, where data come in real time. Sensor and host clocks have
/// nothing in common but their pace: the quickest IMU message of the last seconds says how they differ.
class LatencyMeter {
 public:
  /// An IMU message whose newest sample is from `t` (us, sensor clock) came at `now` (us, host clock).
  void AddData(Utime t, std::int64_t now) {
    if (now - begun_ > kBucketUs || now < begun_) {
      before_ = now - begun_ > 2 * kBucketUs || now < begun_ ? kUnknown : current_;
      current_ = kUnknown;
      begun_ = now;
    }
    current_ = std::min(current_, now - t);
  }

  /// ms from `t` to `now`; negative where data do not come in real time (lossless, another speed, a jump).
  double MsSince(Utime t, std::int64_t now) const {
    if (before_ == kUnknown || current_ == kUnknown) return -1;
    if (now - begun_ > 2 * kBucketUs) return -1;  // no data come any more
    if (std::max(before_, current_) - std::min(before_, current_) > kSameUs) return -1;
    return 1e-3 * static_cast<double>(std::max<std::int64_t>(0, now - t - std::min(before_, current_)));
  }

 private:
  static constexpr std::int64_t kUnknown = std::numeric_limits<std::int64_t>::max();
  static constexpr std::int64_t kBucketUs = 1'000'000;
  static constexpr std::int64_t kSameUs = 20'000;  // between quickest messages of two seconds

  std::int64_t begun_ = 0, current_ = kUnknown, before_ = kUnknown;
};

}  // namespace evit::monitor
