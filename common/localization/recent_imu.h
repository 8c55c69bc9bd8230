#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <vector>

#include "common/tracking/keyframe_input.h"

namespace evit {

/// The IMU samples of the last keyframes, without holes.
class RecentImu {
 public:
  /// False: they do not follow what was there, which is gone; the keyframe's own are kept. `max_gap`, `kept`:
  /// us.
  bool Add(const KeyframeInput& keyframe, double max_gap, Utime kept);
  void Clear() { samples_.clear(); }

  bool empty() const { return samples_.empty(); }
  Utime newest() const { return samples_.back().t; }
  /// Samples of [begin, end], us; keyframes' stamps are among them.
  std::vector<ImuSample> Between(Utime begin, Utime end) const;
  /// The rotation R_end_begin of the body between, by the gyro.
  Eigen::Quaterniond Turn(Utime begin, Utime end) const;

 private:
  std::deque<ImuSample> samples_;
};

}  // namespace evit
