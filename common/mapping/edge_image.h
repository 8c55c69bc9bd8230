#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

namespace evit {

/// A point on an edge of an image.
struct EdgePixel {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();    // sub-pixel
  Eigen::Vector2f normal = Eigen::Vector2f::UnitX();  // unit, across the edge, to the brighter side
  float contrast = 0;                                 // step of log intensity; 0: not known
  float dark = 0, bright = 0;                         // log intensity beside the edge
};

/// The edges of one image, ready to be asked "is there one like this here?" in two ways: very fast and to
/// about a pixel (Vote), and exactly (Match).
class EdgeImage {
 public:
  /// `edges` lie in the image. `has_sides`: normals point to the brighter side; otherwise n and -n are the
  /// same edge.
  EdgeImage(int width, int height, std::vector<EdgePixel> edges, bool has_sides);

  int width() const { return width_; }
  int height() const { return height_; }
  bool has_sides() const { return has_sides_; }
  /// Sorted by cells of the image: a subset of them makes an EdgeImage of the same order.
  const std::vector<EdgePixel>& edges() const { return edges_; }

  /// Directions are told apart in eighths of a turn.
  static constexpr int kBins = 8;
  static int BinOf(const Eigen::Vector2f& normal);
  /// 2: an edge of about this direction (to within some 45 degrees) lies within 0.8 pixels, 1: within 1.6
  /// pixels, 0: none. Requires a pixel of the image.
  int Vote(int column, int row, int bin) const {
    const unsigned mask = masks_[static_cast<std::size_t>(row) * width_ + column] >> bin;
    return static_cast<int>((mask & 1U) + (mask >> kBins & 1U));
  }

  /// What an edge is expected to look like.
  struct Query {
    Eigen::Vector2f pixel, normal;
    float radius = 2;         // pixels, across the edge
    float slack = 1.5F;       // pixels, along it
    float min_cosine = 0.8F;  // of the angle between the normals
  };
  /// The edge nearest across; null where there is none.
  const EdgePixel* Match(const Query& query) const;

  /// Calls visit(edge) for all edges within `reach` pixels in x and y, and some a little farther.
  template <typename Visit>
  void VisitNear(const Eigen::Vector2f& pixel, float reach, const Visit& visit) const {
    const int left = CellOf(pixel.x() - reach, columns_), right = CellOf(pixel.x() + reach, columns_);
    const int top = CellOf(pixel.y() - reach, rows_), bottom = CellOf(pixel.y() + reach, rows_);
    for (int row = top; row <= bottom; ++row) {
      const std::uint32_t end = begin_[row * columns_ + right + 1];
      for (std::uint32_t k = begin_[row * columns_ + left]; k < end; ++k) visit(edges_[k]);
    }
  }

 private:
  static constexpr int kCell = 4;  // pixels
  static int CellOf(float place, int n) {
    return place <= 0 ? 0 : std::min(static_cast<int>(place) / kCell, n - 1);
  }
  void FillMasks();
  void SortIntoCells();

  int width_, height_, columns_, rows_;
  bool has_sides_;
  std::vector<EdgePixel> edges_;      // cell by cell
  std::vector<std::uint32_t> begin_;  // of each cell; one more at the end
  std::vector<std::uint16_t> masks_;  // [height][width]: bit per bin, wide below, near above
};

}  // namespace evit
