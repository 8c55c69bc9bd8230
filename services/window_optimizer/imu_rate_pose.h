#pragma once

#include <optional>
#include <vector>

#include "common/imu/propagation.h"
#include "common/tracking/state.h"
#include "services/window_optimizer/imu_history.h"

namespace evit {

/// The body's pose at each IMU sample as it comes, between keyframes: from the newest keyframe's state, over
/// the samples since. That is a few samples each time, and always the best estimate, whenever the state of a
/// keyframe comes.
class ImuRatePose {
 public:
  /// `gravity`: m/s^2.
  explicit ImuRatePose(double gravity) : gravity_(gravity) {}

  /// Poses start from here: `state` at the keyframe of time `t` (us).
  void StartFrom(Utime t, const BodyState& state);
  /// There are no poses until StartFrom() is called again.
  void Stop() { t_ = 0; }

  /// At sample `t`, which `history` reaches. None where there is nothing to start from, or the history does
  /// not reach back so far.
  std::optional<NavState> At(Utime t, const ImuHistory& history) const;

 private:
  double gravity_;
  Utime t_ = 0;  // us; 0: nothing to start from
  NavState state_;
  ImuBias bias_;
};

}  // namespace evit
