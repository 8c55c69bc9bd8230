#pragma once

#include <cstddef>
#include <vector>

#include "common/photometric/photometric_cells.h"
#include "common/photometric/photometric_view.h"
#include "common/photometric/splat_passes.h"

namespace evit {

/// Renders a photometric map: every point is a small patch of surface as wide as the map is spaced.
///
/// Two passes: a depth buffer of the patches, then a weighted mean (tent kernel, at least a pixel around) of
/// the points that lie on the surface seen, so that the image moves smoothly below a pixel, which nearest
/// points would not. Single pixels through which a farther surface shines, or nothing, are closed. Keep it:
/// its buffers are reused.
class ViewRenderer {
 public:
  /// Intensities get `dark` added before the logarithm, so that black is not infinitely dark. However many
  /// `threads` there are, views are the same to the bit.
  explicit ViewRenderer(const PhotometricMap& map, double dark = kDark, int threads = 1)
      : dark_(static_cast<float>(dark)), threads_(threads), cells_(map) {}
  static constexpr double kDark = 0.012;

  /// The query's camera must have no distortion.
  void Render(const ViewQuery& query, PhotometricView* view);

  std::size_t size() const { return cells_.size(); }
  /// m: side of the square of surface that a point stands for, median.
  float spacing() const { return cells_.spacing(); }

 private:
  void CloseLeaks(const PaddedImage& image, ImageRows rows);
  void TakeMeans(const PaddedImage& image, ImageRows rows, PhotometricView* view) const;
  void FillHoles(const Camera& camera, PhotometricView* view);

  float dark_;
  int threads_;
  PhotometricCells cells_;

  std::vector<Splats> splats_;          // a part of the map for each thread
  std::vector<float> depth_, scratch_;  // m
  SplatSums sums_;
};

}  // namespace evit
