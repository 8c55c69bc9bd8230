#include "common/photometric/splat_passes.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace evit {
namespace {

constexpr float kLargest = 12;  // pixels: half of the largest patch

// Four neighbouring pixels of a row: most patches are not wider. Written as a vector, because the compiler
// makes vectors of the columns otherwise.
constexpr int kAcross = 4;
using Four = float __attribute__((vector_size(4 * kAcross)));
using FourInts = std::int32_t __attribute__((vector_size(4 * kAcross)));

EVIT_ALWAYS_INLINE Four Load(const float* p) {
  Four v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
EVIT_ALWAYS_INLINE void Store(const Four& v, float* p) { std::memcpy(p, &v, sizeof v); }

// The pixels of a block of splats' squares, of half a side of at least `least`: ends are included.
struct SquareLanes {
  alignas(64) float half[kLanes];
  alignas(64) std::int32_t x0[kLanes], x1[kLanes], y0[kLanes], y1[kLanes];

  EVIT_ALWAYS_INLINE void Set(const Splats& s, std::size_t k, float at_1m, float least, int width,
                              ImageRows rows) {
    const float *x = s.x() + k, *y = s.y() + k, *depth = s.depth() + k;
    for (int l = 0; l < kLanes; ++l) {
      const float wanted = at_1m * (1 / depth[l]), most = wanted < kLargest ? wanted : kLargest;
      half[l] = most > least ? most : least;
      Ends(x[l], half[l], 0, width, &x0[l], &x1[l]);
      Ends(y[l], half[l], rows.begin, rows.end, &y0[l], &y1[l]);
    }
  }

 private:
  static EVIT_ALWAYS_INLINE void Ends(float middle, float half, int begin, int end, std::int32_t* first,
                                      std::int32_t* last) {
    const float low = middle - half, high = middle + half;
    const auto l = static_cast<std::int32_t>(low), h = static_cast<std::int32_t>(high);
    const std::int32_t up = l + static_cast<int>(static_cast<float>(l) < low);
    const std::int32_t down = h - static_cast<int>(static_cast<float>(h) > high);
    *first = up > begin ? up : begin;
    *last = down < end - 1 ? down : end - 1;
  }
};

EVIT_MULTIVERSION void FillAll(const Splats& splats, float patch, const PaddedImage& image, ImageRows rows,
                               float* depth) {
  const FourInts columns = {0, 1, 2, 3};
  const Four nothing = {kNoDepth, kNoDepth, kNoDepth, kNoDepth};
  SquareLanes square;
  for (std::size_t k = 0; k < splats.size(); k += kLanes) {
    square.Set(splats, k, patch, 0.5F, image.width, rows);
    for (int l = 0; l < kLanes && k + static_cast<std::size_t>(l) < splats.size(); ++l) {
      const float own = splats.depth()[k + static_cast<std::size_t>(l)];
      const Four all = {own, own, own, own};
      for (int y = square.y0[l]; y <= square.y1[l]; ++y) {
        float* const row = depth + static_cast<std::ptrdiff_t>(y) * image.stride();
        for (int x = square.x0[l]; x <= square.x1[l]; x += kAcross) {
          const Four here = columns <= square.x1[l] - x ? all : nothing, before = Load(row + x);
          Store(before < here ? before : here, row + x);
        }
      }
    }
  }
}

EVIT_MULTIVERSION void BlendAll(const Splats& splats, float reach, const PaddedImage& image, ImageRows rows,
                                float* sums) {
  SquareLanes square;
  for (std::size_t k = 0; k < splats.size(); k += kLanes) {
    square.Set(splats, k, reach, 1, image.width, rows);
    for (int l = 0; l < kLanes && k + static_cast<std::size_t>(l) < splats.size(); ++l) {
      const std::size_t i = k + static_cast<std::size_t>(l);
      const float x_own = splats.x()[i], y_own = splats.y()[i], own = splats.depth()[i];
      const float slope = 1 / square.half[l], same = kSameShare * own + kSame;
      const Four share = {1, splats.intensity()[i], 1 / own, 0};
      for (int y = square.y0[l]; y <= square.y1[l]; ++y) {
        const auto dy = static_cast<float>(y) - y_own;
        const float down = 1 - (dy < 0 ? -dy : dy) * slope;
        float* pixel =
            sums + SplatSums::kNumbers * (static_cast<std::ptrdiff_t>(y) * image.width + square.x0[l]);
        for (int x = square.x0[l]; x <= square.x1[l]; ++x, pixel += SplatSums::kNumbers) {
          const float behind = own - pixel[SplatSums::kDepth];
          if ((behind < 0 ? -behind : behind) > same) continue;
          const auto dx = static_cast<float>(x) - x_own;
          const float w = down * (1 - (dx < 0 ? -dx : dx) * slope);
          Store(Load(pixel) + w * share, pixel);
        }
      }
    }
  }
}

}  // namespace

void FillDepth(const std::vector<Splats>& splats, float patch, const PaddedImage& image, ImageRows rows,
               std::vector<float>* depth) {
  const std::ptrdiff_t stride = image.stride();
  std::fill(depth->begin() + rows.begin * stride, depth->begin() + rows.end * stride, kNoDepth);
  for (const Splats& part : splats) FillAll(part, patch, image, rows, depth->data());
}

void BlendSplats(const std::vector<Splats>& splats, float reach, const PaddedImage& image,
                 const std::vector<float>& depth, ImageRows rows, SplatSums* sums) {
  for (int y = rows.begin; y < rows.end; ++y) {
    const float* seen = depth.data() + static_cast<std::ptrdiff_t>(y) * image.stride();
    float* pixel = sums->Row(y, image.width);
    for (int x = 0; x < image.width; ++x, pixel += SplatSums::kNumbers) {
      const Four none = {0, 0, 0, seen[x]};
      Store(none, pixel);
    }
  }
  for (const Splats& part : splats) BlendAll(part, reach, image, rows, sums->numbers.data());
}

}  // namespace evit
