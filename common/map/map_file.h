#pragma once

#include <cstddef>
#include <string>

#include "common/geometry/se3.h"
#include "common/map/point_map.h"

namespace evit {

/// A map as it was read.
struct LoadedMap {
  PointMap map;
  std::string format;         // e.g. "PCD binary_compressed"
  std::size_t n_dropped = 0;  // points left out because they were not finite (organised clouds hold such)
};

/// How the points of a file are changed while they still are in double precision: scaled, then moved.
struct MapChange {
  double scale = 1;
  SE3 T;
};

/// Reads a point cloud: PCD (ascii, binary, binary_compressed; moved by its VIEWPOINT), PLY (ascii, binary
/// little or big endian) or plain text (`x y z`, more columns ignored, as tolerant as TableReader). The kind
/// is told from the content. Throws std::runtime_error naming file, place, what is wrong and the remedy:
/// unreadable, truncated, wrong counts, no point left.
LoadedMap LoadMap(const std::string& path, const MapChange& change = {});

/// Writes a binary PCD, atomically: x, y, z and, where the map has them, the attributes, as floats under
/// their names. Throws std::runtime_error naming the file.
void WritePcd(const std::string& path, const PointMap& map);
/// The same as a binary PLY where the name ends in .ply.
void WriteMap(const std::string& path, const PointMap& map);

/// Bounds, median and spacing. Requires at least one point.
MapSummary Summarize(const PointMap& map);

/// Throws std::runtime_error with the remedy where the numbers cannot be metres of an indoor or outdoor scene
/// near the camera (a map in millimetres: nothing of it would ever be in view; survey coordinates, which
/// single precision cannot hold).
void RequireMetres(const MapSummary& summary, const std::string& path);

}  // namespace evit
