#pragma once

#include <string>

#include "common/geometry/rig.h"

namespace evit::formats {

/// The calibration that M3ED publishes inside its HDF5 files: intrinsics of one of its two event cameras
/// (`side`: "left" or "right"), their extrinsics and the IMU's, each to the left event camera; noise and rate
/// of its VectorNav VN-100 as M3ED calibrates with them. The body whose poses are the truth is the left event
/// camera. Throws std::runtime_error naming file and dataset.
Rig ReadM3edCalibration(const std::string& path, const std::string& side);

}  // namespace evit::formats
