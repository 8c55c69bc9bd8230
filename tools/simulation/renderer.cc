#include "tools/simulation/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tools/simulation/screen_span.h"
#include "tools/simulation/vector_code.h"

namespace evit {
namespace {

constexpr int kSamples = 16;

// One sample in each of 16 columns and each of 16 rows of the pixel (as rooks on a board), spread over 4 x 4
// cells: an upright or level edge sweeps them one by one.
std::array<std::array<float, kSamples>, 2> SampleOffsets() {
  std::array<std::array<float, kSamples>, 2> offsets{};
  for (int i = 0; i < kSamples; ++i) {
    const int column = i / 4, row = i % 4;
    offsets[0][i] = (static_cast<float>(4 * column + row) + 0.5F) / kSamples - 0.5F;
    offsets[1][i] = (static_cast<float>(4 * row + column) + 0.5F) / kSamples - 0.5F;
  }
  return offsets;
}

}  // namespace

Renderer::Renderer(const Camera& camera, const Scene& scene)
    : camera_(camera), scene_(scene), focal_(static_cast<float>(0.5 * (camera.fx + camera.fy))) {
  const std::size_t n = static_cast<std::size_t>(camera.width) * camera.height;
  ray_x_.assign(n, std::numeric_limits<float>::quiet_NaN());
  ray_y_ = ray_x_;
  bound_x_[0] = bound_y_[0] = 1e9;
  bound_x_[1] = bound_y_[1] = -1e9;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      Eigen::Vector3d ray;
      if (!camera.Unproject({x, y}, &ray)) continue;
      const std::size_t i = static_cast<std::size_t>(y) * camera.width + x;
      ray_x_[i] = static_cast<float>(ray.x());
      ray_y_[i] = static_cast<float>(ray.y());
      bound_x_[0] = std::min(bound_x_[0], ray.x() - 0.02);
      bound_x_[1] = std::max(bound_x_[1], ray.x() + 0.02);
      bound_y_[0] = std::min(bound_y_[0], ray.y() - 0.02);
      bound_y_[1] = std::max(bound_y_[1], ray.y() + 0.02);
    }
  }
}

void Renderer::Render(const SE3& T_map_camera, View* view, const std::vector<Surface>& moving) const {
  const std::size_t n = ray_x_.size();
  view->image.assign(n, 0.0F);
  view->inverse_depth.assign(n, 0.0F);
  view->surface.assign(n, -1);
  const std::size_t n_scene = scene_.surfaces.size();
  std::vector<PlacedSurface> placed(n_scene + moving.size());
  const Eigen::Matrix3d R = T_map_camera.R();
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Surface& surface = i < n_scene ? scene_.surfaces[i] : moving[i - n_scene];
    const bool seen =
        PlaceSurface(surface, static_cast<std::int32_t>(i), R, T_map_camera.p, focal_, &placed[i]);
    if (seen) DrawDepth(placed[i], view);
  }
  Shade(placed, view);
  Smooth(placed, view);
}

bool Renderer::FindSpans(const PlacedSurface& placed, View* view, int* first_row, int* last_row) const {
  return FindScreenSpans(camera_, bound_x_, bound_y_, placed, &view->span_begin, &view->span_end, first_row,
                         last_row);
}

EVIT_VECTOR_CODE void Renderer::DrawDepth(const PlacedSurface& placed, View* view) const {
  int first_row = 0, last_row = -1;
  if (!FindSpans(placed, view, &first_row, &last_row)) return;
  const bool rectangle = placed.surface->kind == Surface::Kind::kRectangle;
  const Eigen::Vector3f w = placed.w, s = placed.s, t = placed.t;
  const std::int32_t index = placed.index;
  for (int y = first_row; y <= last_row; ++y) {
    const int begin = view->span_begin[y], end = view->span_end[y];
    const std::size_t row = static_cast<std::size_t>(y) * camera_.width;
    const float* rx = ray_x_.data() + row;
    const float* ry = ray_y_.data() + row;
    float* depth = view->inverse_depth.data() + row;
    std::int32_t* id = view->surface.data() + row;
    if (rectangle) {
      // Branch-free, so that the compiler makes vector code of it.
      for (int x = begin; x < end; ++x) {
        const float iw = w.x() * rx[x] + w.y() * ry[x] + w.z();
        const float u = s.x() * rx[x] + s.y() * ry[x] + s.z();
        const float v = t.x() * rx[x] + t.y() * ry[x] + t.z();
        const bool in = (iw > depth[x]) & (u >= 0) & (u <= iw) & (v >= 0) & (v <= iw);
        depth[x] = in ? iw : depth[x];
        id[x] = in ? index : id[x];
      }
    } else {
      for (int x = begin; x < end; ++x) {
        const float iw = placed.Meet(rx[x], ry[x]);
        if (!(iw > depth[x])) continue;
        depth[x] = iw;
        id[x] = index;
      }
    }
  }
}

void Renderer::Shade(const std::vector<PlacedSurface>& placed, View* view) const {
  const std::size_t n = view->image.size();
  const std::int32_t* id = view->surface.data();
  for (std::size_t begin = 0, end = 0; begin < n; begin = end) {
    while (end < n && id[end] == id[begin]) ++end;
    if (id[begin] < 0) continue;
    const PlacedSurface& surface = placed[id[begin]];
    if (surface.IsPlane()) {
      ShadePlane(surface, begin, end, view);
      continue;
    }
    for (std::size_t i = begin; i < end; ++i) {
      view->image[i] = surface.Shade(ray_x_[i], ray_y_[i], view->inverse_depth[i]);
    }
  }
}

// As PlacedSurface::Shade, in blocks: what has no branches first, as vector code.
EVIT_VECTOR_CODE void Renderer::ShadePlane(const PlacedSurface& p, std::size_t begin, std::size_t end,
                                           View* view) const {
  constexpr std::size_t kBlock = 64;
  std::array<float, kBlock> u, v, lod;
  const Texture& texture = *p.surface->texture;
  const auto width = static_cast<float>(texture.width()), height = static_cast<float>(texture.height());
  const float gain = p.surface->gain;
  for (; begin < end; begin += kBlock) {
    const std::size_t n = std::min(kBlock, end - begin);
    const float *rx = ray_x_.data() + begin, *ry = ray_y_.data() + begin;
    const float* inverse_depth = view->inverse_depth.data() + begin;
    for (std::size_t i = 0; i < n; ++i) {
      const float z = 1 / inverse_depth[i];
      u[i] = (p.s.x() * rx[i] + p.s.y() * ry[i] + p.s.z()) * z * width;
      v[i] = (p.t.x() * rx[i] + p.t.y() * ry[i] + p.t.z()) * z * height;
      lod[i] = p.lod_offset + 1.6F * ApproximateLog2(z);
    }
    float* image = view->image.data() + begin;
    for (std::size_t i = 0; i < n; ++i) image[i] = gain * texture.Sample(u[i], v[i], lod[i]);
  }
}

void Renderer::Smooth(const std::vector<PlacedSurface>& placed, View* view) const {
  const int width = camera_.width, height = camera_.height;
  for (int y = 1; y + 1 < height; ++y) {
    const std::int32_t* row = view->surface.data() + static_cast<std::size_t>(y) * width;
    for (int x = 1; x + 1 < width; ++x) {
      const std::int32_t* c = row + x;
      if (*c == c[-1] && *c == c[1] && *c == c[-width] && *c == c[width]) continue;
      std::array<std::int32_t, 9> ids{};
      int n_ids = 0;
      for (const int dy : {-width, 0, width}) {
        for (const int dx : {-1, 0, 1}) {
          const std::int32_t id = c[dy + dx];
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

EVIT_VECTOR_CODE float Renderer::SmoothPixel(const std::vector<PlacedSurface>& placed,
                                             const std::int32_t* ids, int n_ids, int x, int y,
                                             float fallback) const {
  static const auto kOffsets = SampleOffsets();
  const std::size_t i = static_cast<std::size_t>(y) * camera_.width + x;
  const float dxx = 0.5F * (ray_x_[i + 1] - ray_x_[i - 1]), dyx = 0.5F * (ray_y_[i + 1] - ray_y_[i - 1]);
  const float dxy = 0.5F * (ray_x_[i + camera_.width] - ray_x_[i - camera_.width]);
  const float dyy = 0.5F * (ray_y_[i + camera_.width] - ray_y_[i - camera_.width]);
  if (!(std::isfinite(dxx + dyx + dxy + dyy))) return fallback;
  std::array<float, kSamples> rx, ry, depth{};
  std::array<std::int32_t, kSamples> winner;
  winner.fill(-1);
  for (int k = 0; k < kSamples; ++k) {
    rx[k] = ray_x_[i] + kOffsets[0][k] * dxx + kOffsets[1][k] * dxy;
    ry[k] = ray_y_[i] + kOffsets[0][k] * dyx + kOffsets[1][k] * dyy;
  }
  for (int j = 0; j < n_ids; ++j) {
    const PlacedSurface& p = placed[ids[j]];
    const bool rectangle = p.surface->kind == Surface::Kind::kRectangle;
    for (int k = 0; k < kSamples; ++k) {
      float iw = 0;
      if (rectangle) {
        iw = p.w.x() * rx[k] + p.w.y() * ry[k] + p.w.z();
        const float u = p.s.x() * rx[k] + p.s.y() * ry[k] + p.s.z();
        const float v = p.t.x() * rx[k] + p.t.y() * ry[k] + p.t.z();
        iw = ((u >= 0) & (u <= iw) & (v >= 0) & (v <= iw)) ? iw : 0;
      } else {
        iw = p.Meet(rx[k], ry[k]);
      }
      const bool nearer = iw > depth[k];
      depth[k] = nearer ? iw : depth[k];
      winner[k] = nearer ? j : winner[k];
    }
  }
  // Each surface is shaded once, in the middle of its samples.
  float sum = 0;
  int covered = 0;
  for (int j = 0; j < n_ids; ++j) {
    std::uint32_t mine = 0;  // bit k: sample k is of this surface
    for (int k = 0; k < kSamples; ++k) mine |= static_cast<std::uint32_t>(winner[k] == j) << k;
    float mean_x = 0, mean_y = 0, mean_depth = 0;
    int count = 0;
    for (; mine != 0; mine &= mine - 1, ++count) {
      const int k = __builtin_ctz(mine);
      mean_x += rx[k];
      mean_y += ry[k];
      mean_depth += depth[k];
    }
    if (count == 0) continue;
    const float share = 1.0F / static_cast<float>(count);
    sum +=
        static_cast<float>(count) * placed[ids[j]].Shade(mean_x * share, mean_y * share, mean_depth * share);
    covered += count;
  }
  return covered > 0 ? sum / static_cast<float>(covered) : fallback;
}

}  // namespace evit
