#pragma once

#include <deque>
#include <vector>

#include "common/imu/imu_sample.h"

namespace evit {

/// The last seconds of IMU samples that the service heard itself: bridges lost keyframes and carries the
/// IMU-rate pose.
class ImuHistory {
 public:
  /// Samples that are not newer than the last one are left out (false).
  bool Add(const ImuSample& sample);
  void Clear() { samples_.clear(); }

  /// Samples from `begin` to `end`, both ends interpolated where they fall between samples. Empty where the
  /// history does not cover the span.
  std::vector<ImuSample> Between(Utime begin, Utime end) const;

  /// Longest distance between two neighbours in a list, us.
  static Utime LongestGap(const std::vector<ImuSample>& samples);

 private:
  static constexpr Utime kSpan = 10 * kMicrosPerSecond;
  std::deque<ImuSample> samples_;
};

}  // namespace evit
