#include "tools/simulation/grey_image.h"

#include <algorithm>
#include <cmath>

namespace evit::simulation {

cv::Mat GreyImage(const std::vector<float>& light, const Camera& camera, double gamma, double noise,
                  Random* random) {
  cv::Mat grey(camera.height, camera.width, CV_32F);
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double share = std::clamp(light[i] / 255.0, 0.0, 1.0);
    const double level = 255 * std::pow(share, 1 / gamma) + noise * random->Gaussian();
    grey.ptr<float>()[i] = static_cast<float>(std::clamp(std::round(level), 0.0, 255.0));
  }
  return grey;
}

}  // namespace evit::simulation
