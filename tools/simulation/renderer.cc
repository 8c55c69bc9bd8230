#include "tools/simulation/renderer.h"

#include <algorithm>
#include <limits>

#include "common/simd/lanes.h"
#include "tools/simulation/four_values.h"
#include "tools/simulation/screen_span.h"

namespace evit::simulation {

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

EVIT_MULTIVERSION void Renderer::DrawDepth(const PlacedSurface& placed, View* view) const {
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

// As PlacedSurface::Shade, four at a time; the last ones repeat the last pixel.
void Renderer::ShadePlane(const PlacedSurface& p, std::size_t begin, std::size_t end, View* view) const {
  const Texture& texture = *p.surface->texture;
  const Eigen::Vector3f s = p.s * static_cast<float>(texture.width());
  const Eigen::Vector3f t = p.t * static_cast<float>(texture.height());
  const float gain = p.surface->gain, lod_offset = p.lod_offset;
  const float *rx = ray_x_.data(), *ry = ray_y_.data(), *w = view->inverse_depth.data();
  for (std::size_t i = begin; i < end; i += 4) {
    const std::size_t i1 = std::min(i + 1, end - 1), i2 = std::min(i + 2, end - 1),
                      i3 = std::min(i + 3, end - 1);
    const Floats x{rx[i], rx[i1], rx[i2], rx[i3]}, y{ry[i], ry[i1], ry[i2], ry[i3]};
    const Floats z = 1 / Floats{w[i], w[i1], w[i2], w[i3]};
    const Floats value =
        gain * texture.Sample((s.x() * x + s.y() * y + s.z()) * z, (t.x() * x + t.y() * y + t.z()) * z,
                              lod_offset + 1.6F * ApproximateLog2(z));
    float* image = view->image.data();
    image[i] = value[0];
    image[i1] = value[1];
    image[i2] = value[2];
    image[i3] = value[3];
  }
}

}  // namespace evit::simulation
