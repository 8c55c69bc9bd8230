#pragma once

#include <string>
#include <vector>

#include "common/map/point_map.h"

namespace evit {

/// What a file written by WriteMap (binary PCD or binary little endian PLY whose columns are x, y, z and the
/// attributes, floats) says of its points beside their places; empty for any other file. `bytes`: all of it;
/// `n`: of the points that were read.
std::vector<PointAttributes> ReadAttributes(const std::string& bytes, std::size_t n);

/// A map as WriteMap writes it: header and rows.
std::string PcdBytes(const PointMap& map);
std::string PlyBytes(const PointMap& map);

}  // namespace evit
