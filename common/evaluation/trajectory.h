#pragma once

#include <string>
#include <vector>

#include "common/geometry/se3.h"
#include "common/time/utime.h"

namespace evit {

struct StampedPose {
  Utime t = 0;  // us
  SE3 pose;     // T_map_body
};

/// In order of time.
using Trajectory = std::vector<StampedPose>;

/// Reads a TUM file (`t[s] x y z qx qy qz qw`, '#' comments). Stamps are parsed as decimal text, so that no
/// microsecond is lost. Throws std::runtime_error naming file, line and what is wrong (fields, non-finite,
/// quaternion norm, order).
Trajectory ReadTum(const std::string& path);

/// One TUM line, stamp with six decimals, pose with nine significant ones. No newline.
std::string TumLine(const StampedPose& pose);

/// Writes a TUM file atomically (temporary file, then rename). Throws std::runtime_error naming the file.
void WriteTum(const std::string& path, const Trajectory& trajectory);

/// The pose at time t by interpolation (line, geodesic). False where t lies outside the trajectory or in a
/// hole longer than `max_gap` us.
bool PoseAt(const Trajectory& trajectory, Utime t, SE3* pose, Utime max_gap = 200'000);

}  // namespace evit
