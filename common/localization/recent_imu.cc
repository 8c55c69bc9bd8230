#include "common/localization/recent_imu.h"

#include <algorithm>

#include "common/geometry/so3.h"

namespace evit {

bool RecentImu::Add(const KeyframeInput& keyframe, double max_gap, Utime kept) {
  const bool follows =
      samples_.empty() || (!keyframe.imu.empty() && keyframe.imu.front().t == samples_.back().t &&
                           static_cast<double>(keyframe.imu_gap) <= max_gap);
  if (!follows) samples_.clear();
  for (const ImuSample& sample : keyframe.imu)
    if (samples_.empty() || sample.t > samples_.back().t) samples_.push_back(sample);
  while (!samples_.empty() && samples_.front().t < keyframe.t - kept) samples_.pop_front();
  return follows;
}

std::vector<ImuSample> RecentImu::Between(Utime begin, Utime end) const {
  const auto before = [](const ImuSample& s, Utime t) { return s.t < t; };
  const auto from = std::lower_bound(samples_.begin(), samples_.end(), begin, before);
  const auto to = std::lower_bound(from, samples_.end(), end + 1, before);
  return {from, to};
}

Eigen::Quaterniond RecentImu::Turn(Utime begin, Utime end) const {
  Eigen::Quaterniond R_begin_end = Eigen::Quaterniond::Identity();
  const std::vector<ImuSample> between = Between(begin, end);
  for (std::size_t k = 1; k < between.size(); ++k) {
    const Eigen::Vector3d rate = 0.5 * (between[k - 1].gyro + between[k].gyro);
    R_begin_end = (R_begin_end * ExpSO3(ToSeconds(between[k].t - between[k - 1].t) * rate)).normalized();
  }
  return R_begin_end.conjugate();
}

}  // namespace evit
