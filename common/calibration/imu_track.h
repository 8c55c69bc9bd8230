#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "common/imu/imu_sample.h"

namespace evit {

/// A recorded stretch of IMU samples that can be cut at any time, and its gyro integrated over all of it.
class ImuTrack {
 public:
  /// `samples`: strictly increasing times, at least two.
  explicit ImuTrack(std::vector<ImuSample> samples);

  Utime begin() const { return samples_.front().t; }
  Utime end() const { return samples_.back().t; }
  bool Covers(Utime t) const { return t >= begin() && t <= end(); }
  const std::vector<ImuSample>& samples() const { return samples_; }

  /// The reading at t, interpolated. Requires Covers(t).
  ImuSample At(Utime t) const;
  /// From `a` to `b`, both ends interpolated. Requires Covers(a), Covers(b), a < b.
  std::vector<ImuSample> Between(Utime a, Utime b) const;
  /// How the body turned from its attitude at begin(), by the raw gyro: body at `t` to body at begin().
  Eigen::Quaterniond Turn(Utime t) const;

 private:
  std::size_t IntervalAt(Utime t) const;  // k with samples_[k].t <= t <= samples_[k + 1].t

  std::vector<ImuSample> samples_;
  std::vector<Eigen::Quaterniond> turns_;  // at each sample
};

/// The longest part of a recording without a hole of more than `max_gap` us and without stamps that go back.
/// Empty where there are no two samples.
std::vector<ImuSample> LongestWhole(const std::vector<ImuSample>& samples, Utime max_gap);

}  // namespace evit
