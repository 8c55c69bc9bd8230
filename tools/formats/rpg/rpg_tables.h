#pragma once

#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/geometry/camera.h"
#include "common/imu/imu_sample.h"
#include "tools/formats/import/drop_counts.h"

namespace evit::formats {

/// The small files of RPG's format. All throw std::runtime_error naming file, line and remedy; rows out of
/// order, not finite or without a rotation are counted and left out.

/// imu.txt: `t ax ay az gx gy gz` (s, m/s^2, rad/s).
std::vector<ImuSample> ReadRpgImu(const std::string& path, DropCounts* dropped);

/// calib.txt: `fx fy cx cy k1 k2 p1 p2 k3`.
Camera ReadRpgCamera(const std::string& path, int width, int height);

/// Samples per second, from the median distance of two, to the nearest whole number.
double ImuRate(const std::vector<ImuSample>& samples);

}  // namespace evit::formats
