#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/imu/imu_sample.h"
#include "common/time/utime.h"

namespace evit::diagnosis {

/// Integrals over time of a gyro or an accelerometer, so that any mean costs two look-ups.
class SampleIntegral {
 public:
  SampleIntegral(const std::vector<ImuSample>& samples, bool gyro) {
    for (const ImuSample& s : samples) {
      const Eigen::Vector3d& v = gyro ? s.gyro : s.accel;
      if (!times_.empty() && s.t <= times_.back()) continue;
      if (times_.empty()) {
        sums_.push_back(Eigen::Vector3d::Zero());
      } else {
        sums_.push_back(sums_.back() + ToSeconds(s.t - times_.back()) * (v + last_) / 2);
      }
      times_.push_back(s.t);
      last_ = v;
    }
  }
  /// Mean over the time; false where it is not covered.
  bool Mean(Utime begin, Utime end, Eigen::Vector3d* mean) const {
    if (times_.size() < 2 || begin < times_.front() || end > times_.back()) return false;
    *mean = (At(end) - At(begin)) / ToSeconds(end - begin);
    return true;
  }

 private:
  Eigen::Vector3d At(Utime t) const {
    const auto it = std::lower_bound(times_.begin(), times_.end(), t);
    const auto k = static_cast<std::size_t>(it - times_.begin());
    if (k == 0) return sums_.front();
    const double share = ToSeconds(t - times_[k - 1]) / ToSeconds(times_[k] - times_[k - 1]);
    return sums_[k - 1] + share * (sums_[k] - sums_[k - 1]);
  }
  std::vector<Utime> times_;
  std::vector<Eigen::Vector3d> sums_;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
};

}  // namespace evit::diagnosis
