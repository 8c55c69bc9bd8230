#pragma once

#include <optional>
#include <string>

#include "common/geometry/rig.h"

namespace evit::formats {

/// A calibration in Basalt's JSON, as TUM-VIE publishes it: of its cameras the first with this resolution
/// (TUM-VIE's left event camera is the first of 1280x720), with its extrinsics to the IMU, the IMU's noise
/// and rate, and the time offset. Models kb4 (equidistant) and pinhole-radtan8 without its rational terms.
/// Throws std::runtime_error naming file, field and what is wrong.
Rig ReadBasaltCalibration(const std::string& path, int width, int height);

/// The marker body in the IMU's frame (T_imu_marker), as TUM-VIE publishes it in a file of its own; none
/// where the file has none. Throws as above.
std::optional<SE3> ReadBasaltMarker(const std::string& path);
bool HasBasaltCameras(const std::string& path);

}  // namespace evit::formats
