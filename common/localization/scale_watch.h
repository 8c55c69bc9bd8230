#pragma once

#include <vector>

#include "common/localization/motion_fit.h"

namespace evit {

/// Watches the first seconds after a start without a pose: whether the poses go as far as the accelerometer
/// felt. A second may be too short to tell, where a body moves evenly.
class ScaleWatch {
 public:
  enum class Verdict { kOpen, kAgrees, kDisagrees };

  explicit ScaleWatch(double gravity) : gravity_(gravity) {}

  void Begin();
  /// A tracked keyframe's pose and the IMU samples up to it. For 10 s at most, then it agrees.
  Verdict Add(Utime t, const SE3& T_map_body, const std::vector<ImuSample>& imu);
  const MotionFit& fit() const { return fit_; }

 private:
  double gravity_;
  Utime begun_ = 0, fitted_ = 0;  // us
  std::vector<FollowedPlace::Step> steps_;
  std::vector<ImuSample> imu_;
  MotionFit fit_;
  int disagreed_ = 0;  // last fits in a row
};

}  // namespace evit
