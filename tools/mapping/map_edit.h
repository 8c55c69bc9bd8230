#pragma once

#include <string>
#include <vector>

#include "common/geometry/se3.h"
#include "common/map/point_map.h"

/// Changes of whole maps. Attributes go along.
namespace evit::mapping {

/// Points become T * (scale * p).
void Transform(const SE3& T, double scale, PointMap* map);

/// One point for each cell of `size` metres: that with the least sigma, without sigmas the first.
void Thin(double size, PointMap* map);

/// One map of all; attributes stay only where all maps have them. `voxel`: m, as in Thin; 0: all stay.
PointMap Merge(const std::vector<PointMap>& maps, double voxel);

struct CropBox {
  Eigen::Vector3f min, max;  // m
};
/// "x0:x1,y0:y1,z0:z1"; an end left out is open. Throws std::runtime_error naming the option.
CropBox ParseBox(const std::string& option, const std::string& text);
/// Keeps what lies in the box, or, `inverted`, what does not.
void Crop(const CropBox& box, bool inverted, PointMap* map);

}  // namespace evit::mapping
