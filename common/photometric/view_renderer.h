#pragma once

#include <cstdint>
#include <vector>

#include "common/map/photometric_map.h"
#include "common/photometric/photometric_view.h"

namespace evit {

/// Renders a photometric map: every point is a small patch of surface as wide as the map is spaced.
///
/// Two passes: a depth buffer of the patches, then a weighted mean (tent kernel, at least a pixel around) of
/// the points that lie on the surface seen, so that the image moves smoothly below a pixel, which nearest
/// points would not. Single pixels through which a farther surface shines, or nothing, are closed. Keep it:
/// its buffers are reused.
class ViewRenderer {
 public:
  /// Intensities get `dark` added before the logarithm, so that black is not infinitely dark.
  explicit ViewRenderer(const PhotometricMap& map, double dark = 0.012);

  /// The query's camera must have no distortion.
  void Render(const ViewQuery& query, PhotometricView* view);

  std::size_t size() const { return x_.size(); }
  /// m: side of the square of surface that a point stands for, median.
  float spacing() const { return spacing_; }

 private:
  struct Cell {
    Eigen::Vector3f center;
    float radius;            // m
    std::size_t begin, end;  // points
  };
  struct Splat {
    float x, y, depth, intensity;  // pixels, m
  };
  void Project(const ViewQuery& query);
  void FillDepth(const Camera& camera);
  void CloseLeaks(int width, int height);
  void Blend(const Camera& camera, PhotometricView* view);
  void FillHoles(const Camera& camera, PhotometricView* view);

  float dark_;
  float spacing_ = 0;
  std::vector<Cell> cells_;
  std::vector<float> x_, y_, z_, intensity_;  // cell by cell

  std::vector<Splat> splats_;
  std::vector<float> depth_, scratch_;          // m; kNothing
  std::vector<float> weight_, mean_, inverse_;  // sums
};

}  // namespace evit
