#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

#include "tools/simulation/four_values.h"

namespace evit::simulation {

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

  /// The same for four at once.
  Floats Sample(Floats s, Floats t, Floats lod) const;

 private:
  // Its rows are one texel longer and its columns one higher than the picture, with the border's value.
  struct Level {
    int width, height;       // of the picture
    float scale_s, scale_t;  // texels of this level per texel of level 0
    std::vector<float> data;
  };

  float SampleLevel(int index, float s, float t) const {
    const Level& level = levels_[index];
    const float max_x = static_cast<float>(level.width - 1), max_y = static_cast<float>(level.height - 1);
    float x = s * level.scale_s - 0.5F, y = t * level.scale_t - 0.5F;
    x = x < 0 ? 0 : (x > max_x ? max_x : x);
    y = y < 0 ? 0 : (y > max_y ? max_y : y);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y), stride = level.width + 1;
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    const float* p = level.data.data() + static_cast<std::ptrdiff_t>(y0) * stride + x0;
    const float a = p[0] + fx * (p[1] - p[0]), b = p[stride] + fx * (p[stride + 1] - p[stride]);
    return a + fy * (b - a);
  }
  static Floats SampleLevel(const Level& level, Floats s, Floats t);

  float texel_size_;
  std::vector<Level> levels_;
};

inline Floats Texture::SampleLevel(const Level& level, Floats s, Floats t) {
  const auto max_x = static_cast<float>(level.width - 1), max_y = static_cast<float>(level.height - 1);
  const int stride = level.width + 1;
  const Floats x = Clamp(s * level.scale_s - 0.5F, max_x), y = Clamp(t * level.scale_t - 0.5F, max_y);
  const Ints x0 = __builtin_convertvector(x, Ints), y0 = __builtin_convertvector(y, Ints);
  const Floats fx = x - __builtin_convertvector(x0, Floats), fy = y - __builtin_convertvector(y0, Floats);
  const Ints at = y0 * stride + x0;
  const float *p0 = level.data.data() + at[0], *p1 = level.data.data() + at[1];
  const float *p2 = level.data.data() + at[2], *p3 = level.data.data() + at[3];
  const Floats a0{p0[0], p1[0], p2[0], p3[0]}, a1{p0[1], p1[1], p2[1], p3[1]};
  const Floats b0{p0[stride], p1[stride], p2[stride], p3[stride]};
  const Floats b1{p0[stride + 1], p1[stride + 1], p2[stride + 1], p3[stride + 1]};
  const Floats a = a0 + fx * (a1 - a0), b = b0 + fx * (b1 - b0);
  return a + fy * (b - a);
}

inline Floats Texture::Sample(Floats s, Floats t, Floats lod) const {
  const Floats clamped = Clamp(lod, static_cast<float>(levels_.size() - 1));
  const float lowest = std::min(std::min(clamped[0], clamped[1]), std::min(clamped[2], clamped[3]));
  const float highest = std::max(std::max(clamped[0], clamped[1]), std::max(clamped[2], clamped[3]));
  const int level = static_cast<int>(lowest);
  const auto base = static_cast<float>(level);
  if (highest - base >= 1) {  // not between the same two levels
    Floats value;
    for (int k = 0; k < 4; ++k) value[k] = Sample(s[k], t[k], lod[k]);
    return value;
  }
  const Floats share = Clamp(2 * (clamped - base) - 0.5F, 1);
  if (2 * (lowest - base) - 0.5F >= 1) return SampleLevel(levels_[level + 1], s, t);
  const Floats fine = SampleLevel(levels_[level], s, t);
  if (2 * (highest - base) - 0.5F <= 0) return fine;
  return fine + share * (SampleLevel(levels_[level + 1], s, t) - fine);
}

}  // namespace evit::simulation
