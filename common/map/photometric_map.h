#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace evit {

/// A dense map with brightness: points on the scene's surfaces, map frame (z up), metres. Both vectors have
/// one length.
struct PhotometricMap {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> intensities;  // 0..1
};

/// Reads a PLY with the vertex properties x, y, z and intensity (0..1). Throws std::runtime_error naming the
/// file, what is wrong and the remedy: unreadable, truncated, no intensity, no point left. Points that are
/// not finite are left out.
PhotometricMap LoadPhotometricMap(const std::string& path);

/// Writes a binary PLY (float x y z intensity), atomically. Throws std::runtime_error naming the file.
void WritePhotometricMap(const std::string& path, const PhotometricMap& map);

}  // namespace evit
