#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/se3.h"
#include "tools/simulation/placed_surface.h"
#include "tools/simulation/scene.h"

namespace evit::simulation {

/// One rendered view, row-major, width x height; keep it between renders, it is working memory too.
struct View {
  std::vector<float> image;           // grey, linear light
  std::vector<float> inverse_depth;   // 1/m along the optical axis at the pixel's centre; 0: nothing
  std::vector<std::int32_t> surface;  // index of the surface there; -1: nothing

  std::vector<std::int16_t> span_begin, span_end;  // scratch, per row
};

/// Draws a scene as a distorting camera sees it. Deterministic; const, so threads may share it.
/// Depth buffer over conservative screen spans (exact ray against surface in each pixel), trilinear textures,
/// and 16 samples per pixel along the borders of surfaces, so that edges move smoothly below a pixel.
class Renderer {
 public:
  Renderer(const Camera& camera, const Scene& scene);

  /// `moving`: further surfaces, where they are now; View::surface counts them after the scene's.
  void Render(const SE3& T_map_camera, View* view, const std::vector<Surface>& moving = {}) const;

  const Camera& camera() const { return camera_; }
  const Scene& scene() const { return scene_; }

 private:
  bool FindSpans(const PlacedSurface& placed, View* view, int* first_row, int* last_row) const;
  void DrawDepth(const PlacedSurface& placed, View* view) const;
  void Shade(const std::vector<PlacedSurface>& placed, View* view) const;
  void ShadePlane(const PlacedSurface& placed, std::size_t begin, std::size_t end, View* view) const;
  // The borders of surfaces: border_smoothing.cc.
  void Smooth(const std::vector<PlacedSurface>& placed, View* view) const;
  float SmoothPixel(const std::vector<PlacedSurface>& placed, const std::int32_t* ids, int n_ids, int x,
                    int y, float fallback) const;

  Camera camera_;
  const Scene& scene_;
  float focal_;
  double bound_x_[2], bound_y_[2];    // of the rays over the image, with a margin
  std::vector<float> ray_x_, ray_y_;  // per pixel, z == 1; NaN where the lens model has no ray
};

}  // namespace evit::simulation
