#pragma once

#include <vector>

namespace evit::simulation {

/// What lies between the rendered light and the pixels.
struct OpticsSettings {
  double blur_px = 0;          // standard deviation of the lens's point spread and of its defocus
  double saturation_grey = 0;  // light beyond it makes no difference; 0: none is too bright
};

/// Applies both to an image (grey, linear), row-major [height][width].
void ApplyOptics(const OpticsSettings& settings, int width, int height, std::vector<float>* image);

}  // namespace evit::simulation
