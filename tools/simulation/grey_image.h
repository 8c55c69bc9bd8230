#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "common/geometry/camera.h"
#include "tools/simulation/random.h"

namespace evit::simulation {

/// What a regular camera delivers of linear light (0..255, [height][width]): gamma, noise (grey levels),
/// whole grey levels 0..255. CV_32F.
cv::Mat GreyImage(const std::vector<float>& light, const Camera& camera, double gamma, double noise,
                  Random* random);

}  // namespace evit::simulation
