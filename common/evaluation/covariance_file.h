#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/geometry/se3.h"
#include "common/time/utime.h"

namespace evit {

/// Covariance of one pose: position (m, map frame), rotation (rad, right perturbation, body frame). All zero
/// where the tracker gave none (bootstrapping).
struct StampedCovariance {
  Utime t = 0;  // us
  Matrix6d covariance = Matrix6d::Zero();
};

/// In order of time.
using Covariances = std::vector<StampedCovariance>;

/// Reads `utime,c00,c01,...,c55`: microseconds and the 21 numbers of the upper triangle, row by row; '#'
/// comments. Throws std::runtime_error naming file, line and what is wrong (fields, non-finite, order).
Covariances ReadCovariances(const std::string& path);

/// Writes such a file atomically, nine significant digits; poses without a covariance (all zero) are left
/// out, so that a reader does not take them for exact. Throws std::runtime_error naming the file.
void WriteCovariances(const std::string& path, const Covariances& covariances);

}  // namespace evit
