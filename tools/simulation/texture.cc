#include "tools/simulation/texture.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace evit::simulation {

Texture::Texture(const cv::Mat& picture, float texel_size, bool smooth) : texel_size_(texel_size) {
  cv::Mat image = picture;
  while (true) {
    Level level;
    level.width = image.cols;
    level.height = image.rows;
    level.scale_s = static_cast<float>(image.cols) / static_cast<float>(picture.cols);
    level.scale_t = static_cast<float>(image.rows) / static_cast<float>(picture.rows);
    for (int y = 0; y <= image.rows; ++y) {
      const float* row = image.ptr<float>(std::min(y, image.rows - 1));
      level.data.insert(level.data.end(), row, row + image.cols);
      level.data.push_back(row[image.cols - 1]);
    }
    levels_.push_back(std::move(level));
    if (smooth || (image.cols == 1 && image.rows == 1)) break;
    cv::Mat half;
    cv::resize(image, half, {std::max(1, image.cols / 2), std::max(1, image.rows / 2)}, 0, 0, cv::INTER_AREA);
    image = half;
  }
}

}  // namespace evit::simulation
