#pragma once

#include <optional>
#include <string>

#include "common/geometry/se3.h"
#include "common/imu/imu_sample.h"
#include "common/tracking/state.h"

namespace evit {

/// What a restarted optimiser needs to go on: the state at the newest keyframe.
struct Checkpoint {
  Utime t = 0;  // us
  BodyState state;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  // rad/s, body frame

  /// The state `dt` us later at constant velocity and rate.
  BodyState After(Utime dt) const;
};

/// Written whole or not at all (temporary file, then rename). False where it cannot be.
bool SaveCheckpoint(const std::string& path, const Checkpoint& checkpoint);

/// None where there is no such file, or it is not a checkpoint.
std::optional<Checkpoint> LoadCheckpoint(const std::string& path);

}  // namespace evit
