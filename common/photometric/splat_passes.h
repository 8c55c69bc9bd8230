#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "common/photometric/splats.h"

namespace evit {

/// Depth of a pixel that sees nothing.
inline constexpr float kNoDepth = std::numeric_limits<float>::max();
/// Of the depth, and m: points this near to each other are on one surface.
inline constexpr float kSameShare = 0.03F, kSame = 0.01F;

/// Size of an image whose rows are longer than it is wide by a vector less one, so that vectors may begin at
/// any pixel.
struct PaddedImage {
  int width = 0, height = 0;  // pixels
  int stride() const { return width + 3; }
  std::size_t size() const { return static_cast<std::size_t>(stride()) * static_cast<std::size_t>(height); }
};

/// Rows [begin, end) of an image: what one thread draws.
struct ImageRows {
  int begin, end;
};

/// Sums over the splats that each pixel sees, four numbers a pixel, row-major: weight, weighted intensity,
/// weighted inverse depth (1/m), and the depth (m) seen, which is no sum.
struct SplatSums {
  static constexpr std::ptrdiff_t kNumbers = 4, kDepth = 3;
  std::vector<float> numbers;
  float* Row(int y, int width) { return numbers.data() + kNumbers * y * width; }
  const float* Row(int y, int width) const { return numbers.data() + kNumbers * y * width; }
};

/// Depth (m) of the nearest patch of each pixel, in some rows. `patch`: pixels * m, half of a patch's side at
/// 1 m. `depth`: of the image's size.
void FillDepth(const std::vector<Splats>& splats, float patch, const PaddedImage& image, ImageRows rows,
               std::vector<float>* depth);

/// Adds each splat to the pixels around it whose depth is its own, by a tent, in some rows. `reach`: pixels *
/// m, the tent's radius at 1 m; at least a pixel. `sums`: of width * height pixels.
void BlendSplats(const std::vector<Splats>& splats, float reach, const PaddedImage& image,
                 const std::vector<float>& depth, ImageRows rows, SplatSums* sums);

}  // namespace evit
