#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

namespace evit {

/// A picture (CV_32F, grey 0..255) with its mip levels, filtered trilinearly. Beyond its border it continues
/// with the border's value.
class Texture {
 public:
  /// `texel_size`: metres per texel of level 0, the same in both directions. `smooth`: a picture without
  /// detail, which needs no further levels.
  Texture(const cv::Mat& picture, float texel_size, bool smooth);

  float texel_size() const { return texel_size_; }
  int width() const { return levels_[0].width; }
  int height() const { return levels_[0].height; }

  /// Value at (s, t), in texels of level 0 (0 is the left/top border), averaged over about 2^lod texels.
  float Sample(float s, float t, float lod) const {
    const float top = static_cast<float>(levels_.size() - 1);
    lod = lod < 0 ? 0 : (lod > top ? top : lod);
    const int level = static_cast<int>(lod);
    // Blended over the middle half between two levels: continuous, and half of the pixels read one level
    // only.
    const float rest = 2 * (lod - static_cast<float>(level)) - 0.5F;
    if (rest <= 0) return SampleLevel(level, s, t);
    if (rest >= 1) return SampleLevel(level + 1, s, t);
    const float a = SampleLevel(level, s, t);
    return a + rest * (SampleLevel(level + 1, s, t) - a);
  }

 private:
  struct Level {
    int width, height;
    float scale_s, scale_t;  // texels of this level per texel of level 0
    std::vector<float> data;
  };
  float SampleLevel(int index, float s, float t) const {
    const Level& level = levels_[index];
    const float max_x = static_cast<float>(level.width - 1), max_y = static_cast<float>(level.height - 1);
    float x = s * level.scale_s - 0.5F, y = t * level.scale_t - 0.5F;
    x = x < 0 ? 0 : (x > max_x ? max_x : x);
    y = y < 0 ? 0 : (y > max_y ? max_y : y);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int dx = x0 + 1 < level.width ? 1 : 0;
    const std::size_t dy = y0 + 1 < level.height ? level.width : 0;
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    const float* p = level.data.data() + static_cast<std::size_t>(y0) * level.width + x0;
    const float a = p[0] + fx * (p[dx] - p[0]), b = p[dy] + fx * (p[dy + dx] - p[dy]);
    return a + fy * (b - a);
  }

  float texel_size_;
  std::vector<Level> levels_;
};

}  // namespace evit
