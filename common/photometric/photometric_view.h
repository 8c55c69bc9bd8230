#pragma once

#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/se3.h"

namespace evit {

/// From where a photometric map is looked at.
struct ViewQuery {
  SE3 T_map_camera;
  Camera camera;           // without distortion
  double min_depth = 0.1;  // m
  double max_depth = 12;   // m
};

/// How a photometric map looks from there; both images row-major [height][width].
struct PhotometricView {
  ViewQuery query;
  std::vector<float> log_intensity;  // natural logarithm; 0 where nothing is seen
  std::vector<float> inverse_depth;  // 1/m along the optical axis; 0: nothing is seen
};

/// The pinhole camera for views of what `camera` sees: half as wide and high, its field of view wider by the
/// share `margin`.
Camera ViewCamera(const Camera& camera, double margin);

}  // namespace evit
