// Renderer::Smooth: pixels where surfaces meet get 16 samples.
#include <algorithm>
#include <array>
#include <cmath>

#include "common/simd/lanes.h"
#include "tools/simulation/four_values.h"
#include "tools/simulation/renderer.h"

namespace evit::simulation {
namespace {

constexpr int kSamples = 16, kVectors = 4;  // of a pixel

// One sample in each of 16 columns and each of 16 rows of the pixel (as rooks on a board), spread over 4 x 4
// cells: an upright or level edge sweeps them one by one.
constexpr Floats Offset(float first, float step) {
  return Floats{first, first + step, first + 2 * step, first + 3 * step} / 16.0F - 15.0F / 32;
}
constexpr Floats kOffsetX[kVectors] = {Offset(0, 1), Offset(4, 1), Offset(8, 1), Offset(12, 1)};
constexpr Floats kOffsetY[kVectors] = {Offset(0, 4), Offset(1, 4), Offset(2, 4), Offset(3, 4)};

// Their rays, the inverse depth of the nearest surface and which it is.
struct Samples {
  Floats x[kVectors], y[kVectors], depth[kVectors];
  Ints winner[kVectors];

  void Meet(const PlacedSurface& p, std::int32_t j) {
    const Eigen::Vector3f w = p.w, s = p.s, t = p.t;
    const bool rectangle = p.surface->kind == Surface::Kind::kRectangle;
    for (int n = 0; n < kVectors; ++n) {
      Floats inverse_depth{};
      if (rectangle) {
        const Floats iw = w.x() * x[n] + w.y() * y[n] + w.z();
        const Floats u = s.x() * x[n] + s.y() * y[n] + s.z();
        const Floats v = t.x() * x[n] + t.y() * y[n] + t.z();
        const Ints in = (u >= 0) & (u <= iw) & (v >= 0) & (v <= iw);
        inverse_depth = in ? iw : inverse_depth;
      } else {
        for (int k = 0; k < 4; ++k) inverse_depth[k] = p.Meet(x[n][k], y[n][k]);
      }
      const Ints nearer = inverse_depth > depth[n];
      depth[n] = nearer ? inverse_depth : depth[n];
      winner[n] = nearer ? Ints{j, j, j, j} : winner[n];
    }
  }
};

// The samples of one surface.
struct Share {
  Ints of[kVectors];

  Share(const Samples& samples, std::int32_t j) {
    for (int n = 0; n < kVectors; ++n) of[n] = samples.winner[n] == j;
  }
  int Count() const {
    const Ints sum = (of[0] + of[1]) + (of[2] + of[3]);
    return -(sum[0] + sum[1] + sum[2] + sum[3]);
  }
  float Sum(const Floats* values) const {
    Floats sum{};
    for (int n = 0; n < kVectors; ++n) sum += of[n] ? values[n] : Floats{};
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
};

}  // namespace

EVIT_MULTIVERSION void Renderer::Smooth(const std::vector<PlacedSurface>& placed, View* view) const {
  const int width = camera_.width, height = camera_.height;
  std::vector<std::uint8_t> border(width);
  for (int y = 1; y + 1 < height; ++y) {
    const std::int32_t* row = view->surface.data() + static_cast<std::size_t>(y) * width;
    for (int x = 1; x + 1 < width; ++x) {
      const std::int32_t* c = row + x;
      border[x] =
          static_cast<std::uint8_t>((*c != c[-1]) | (*c != c[1]) | (*c != c[-width]) | (*c != c[width]));
    }
    for (int x = 1; x + 1 < width; ++x) {
      if (border[x] == 0) continue;
      std::array<std::int32_t, 9> ids{row[x]};  // its own surface first
      int n_ids = row[x] >= 0 ? 1 : 0;
      for (const int dy : {-width, 0, width}) {
        for (const int dx : {-1, 0, 1}) {
          const std::int32_t id = row[x + dy + dx];
          if (id >= 0 && std::find(ids.begin(), ids.begin() + n_ids, id) == ids.begin() + n_ids) {
            ids[n_ids++] = id;
          }
        }
      }
      float& pixel = view->image[static_cast<std::size_t>(y) * width + x];
      pixel = SmoothPixel(placed, ids.data(), n_ids, x, y, pixel);
    }
  }
}

float Renderer::SmoothPixel(const std::vector<PlacedSurface>& placed, const std::int32_t* ids, int n_ids,
                            int x, int y, float fallback) const {
  const std::size_t i = static_cast<std::size_t>(y) * camera_.width + x;
  const float dxx = 0.5F * (ray_x_[i + 1] - ray_x_[i - 1]), dyx = 0.5F * (ray_y_[i + 1] - ray_y_[i - 1]);
  const float dxy = 0.5F * (ray_x_[i + camera_.width] - ray_x_[i - camera_.width]);
  const float dyy = 0.5F * (ray_y_[i + camera_.width] - ray_y_[i - camera_.width]);
  if (!(std::isfinite(dxx + dyx + dxy + dyy))) return fallback;
  Samples samples;
  const float ray_x = ray_x_[i], ray_y = ray_y_[i];
  for (int n = 0; n < kVectors; ++n) {
    samples.x[n] = ray_x + kOffsetX[n] * dxx + kOffsetY[n] * dxy;
    samples.y[n] = ray_y + kOffsetX[n] * dyx + kOffsetY[n] * dyy;
    samples.depth[n] = Floats{};
    samples.winner[n] = Ints{-1, -1, -1, -1};
  }
  for (int j = 0; j < n_ids; ++j) samples.Meet(placed[ids[j]], j);
  // Each surface is shaded once, in the middle of its samples.
  float sum = 0;
  int covered = 0;
  for (int j = 0; j < n_ids; ++j) {
    const Share mine(samples, j);
    const int count = mine.Count();
    if (count == 0) continue;
    if (count == kSamples && j == 0) return fallback;  // the border passes beside this pixel
    const float share = 1.0F / static_cast<float>(count);
    sum += static_cast<float>(count) * placed[ids[j]].Shade(mine.Sum(samples.x) * share,
                                                            mine.Sum(samples.y) * share,
                                                            mine.Sum(samples.depth) * share);
    covered += count;
  }
  return covered > 0 ? sum / static_cast<float>(covered) : fallback;
}

}  // namespace evit::simulation
