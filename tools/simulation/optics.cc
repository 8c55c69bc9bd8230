#include "tools/simulation/optics.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace evit::simulation {

void ApplyOptics(const OpticsSettings& settings, int width, int height, std::vector<float>* image) {
  if (settings.blur_px > 0) {
    cv::Mat pixels(height, width, CV_32F, image->data());
    cv::GaussianBlur(pixels, pixels, {0, 0}, settings.blur_px, 0, cv::BORDER_REPLICATE);
  }
  if (settings.saturation_grey > 0) {
    const auto most = static_cast<float>(settings.saturation_grey);
    for (float& pixel : *image) pixel = std::min(pixel, most);
  }
}

}  // namespace evit::simulation
