#include "common/calibration/imu_track.h"

#include <algorithm>
#include <utility>

#include "common/geometry/so3.h"

namespace evit {

ImuTrack::ImuTrack(std::vector<ImuSample> samples) : samples_(std::move(samples)) {
  turns_.reserve(samples_.size());
  turns_.push_back(Eigen::Quaterniond::Identity());
  for (std::size_t k = 1; k < samples_.size(); ++k) {
    const ImuSample &a = samples_[k - 1], &b = samples_[k];
    turns_.push_back((turns_.back() * ExpSO3(0.5 * ToSeconds(b.t - a.t) * (a.gyro + b.gyro))).normalized());
  }
}

std::size_t ImuTrack::IntervalAt(Utime t) const {
  const auto after = std::upper_bound(samples_.begin() + 1, samples_.end() - 1, t,
                                      [](Utime time, const ImuSample& s) { return time < s.t; });
  return static_cast<std::size_t>(after - samples_.begin()) - 1;
}

ImuSample ImuTrack::At(Utime t) const {
  const std::size_t k = IntervalAt(t);
  return InterpolateImu(samples_[k], samples_[k + 1], t);
}

std::vector<ImuSample> ImuTrack::Between(Utime a, Utime b) const {
  std::vector<ImuSample> part{At(a)};
  for (std::size_t k = IntervalAt(a) + 1; k < samples_.size() && samples_[k].t < b; ++k) {
    if (samples_[k].t > a) part.push_back(samples_[k]);
  }
  part.push_back(At(b));
  return part;
}

Eigen::Quaterniond ImuTrack::Turn(Utime t) const {
  const std::size_t k = IntervalAt(t);
  const ImuSample& a = samples_[k];
  return turns_[k] * ExpSO3(0.5 * ToSeconds(t - a.t) * (a.gyro + At(t).gyro));
}

std::vector<ImuSample> LongestWhole(const std::vector<ImuSample>& samples, Utime max_gap) {
  std::size_t best = 0, best_begin = 0, begin = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k > begin) {
      const Utime step = samples[k].t - samples[k - 1].t;
      if (step <= 0 || step > max_gap) begin = k;
    }
    if (k + 1 - begin > best) best = k + 1 - begin, best_begin = begin;
  }
  if (best < 2) return {};
  const auto first = samples.begin() + static_cast<std::ptrdiff_t>(best_begin);
  return {first, first + static_cast<std::ptrdiff_t>(best)};
}

}  // namespace evit
