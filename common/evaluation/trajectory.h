#pragma once

#include <cstdint>
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

/// Rows of a TUM file that were passed over: a time that is repeated, goes back, or lies far ahead of all
/// that follow.
struct TumSkipped {
  std::int64_t rows = 0, first_line = 0;
  /// "3 rows skipped, the first in line 12: ..."; empty where none was.
  std::string Text(const std::string& path) const;
};

/// Reads a TUM file (`t[s] x y z qx qy qz qw`; as tolerant as TableReader; times in ns or us are told by
/// their digits), or another table whose head names these columns (PoseColumnsOf). Stamps are parsed as
/// decimal text, so that no microsecond is lost. Rows out of order or with numbers that are not finite are
/// passed over and told through `skipped`; where that is null, they are an error. Throws std::runtime_error
/// naming file, line and what is wrong (fields, quaternion norm, more than a twentieth of the rows out of
/// order).
Trajectory ReadTum(const std::string& path, TumSkipped* skipped = nullptr);

/// One TUM line, stamp with six decimals, pose with nine significant ones. No newline.
std::string TumLine(const StampedPose& pose);

/// Writes a TUM file atomically (temporary file, then rename). Throws std::runtime_error naming the file.
void WriteTum(const std::string& path, const Trajectory& trajectory);

/// The pose at time t by interpolation (line, geodesic). False where t lies outside the trajectory or in a
/// hole longer than `max_gap` us.
bool PoseAt(const Trajectory& trajectory, Utime t, SE3* pose, Utime max_gap = 200'000);

}  // namespace evit
