#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <vector>

#include "common/geometry/rig.h"
#include "common/imu/imu_sample.h"

namespace evit {

/// Whether an IMU's readings stay the same, as they do when the body stands still, and also when it moves
/// evenly. Vibration does not count where it averages out within 50 ms.
class Steadiness {
 public:
  /// `noise`: calibrated densities.
  explicit Steadiness(const ImuNoise& noise) : noise_(noise) {}

  /// Samples in order of time; one that is not newer than the newest so far is left out.
  void Add(const std::vector<ImuSample>& samples);

  /// Mean reading of the last quarter of a second, or since `begin` (us) where that is longer, at the newest
  /// sample's time, if the readings stayed the same for so long and none are missing.
  std::optional<ImuSample> SteadyReading(Utime begin) const;

 private:
  ImuNoise noise_;
  std::deque<ImuSample> samples_;  // of the last second
};

}  // namespace evit
