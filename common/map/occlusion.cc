#include "common/map/occlusion.h"

#include <algorithm>
#include <limits>

namespace evit {
namespace {

constexpr float kCell = 8;          // pixels
constexpr int kReach = 2;           // cells around
constexpr float kRelative = 0.10F;  // a nearer surface is nearer by this share of the depth
constexpr float kAbsolute = 0.05F;  // and by this much, m

constexpr float kNone = std::numeric_limits<float>::max();

// For each cell the two smallest depths of a set of points, m. Two points must agree before a cell or
// quadrant counts as a nearer surface. With a border of kReach empty cells on each side.
struct DepthGrid {
  DepthGrid(int columns, int rows)
      : stride(columns + 2 * kReach),
        first(static_cast<std::size_t>(stride) * (rows + 2 * kReach), kNone),
        second(first) {}
  int stride;
  std::vector<float> first, second;
};

// out[k] = the two smallest of a[k] and b[k + shift], for all k but the last `shift`.
void Merge(const DepthGrid& a, const DepthGrid& b, int shift, DepthGrid* out) {
  const std::size_t n = a.first.size() - static_cast<std::size_t>(shift);
  const float* __restrict a1 = a.first.data();
  const float* __restrict a2 = a.second.data();
  const float* __restrict b1 = b.first.data() + shift;
  const float* __restrict b2 = b.second.data() + shift;
  float* __restrict o1 = out->first.data();
  float* __restrict o2 = out->second.data();
  for (std::size_t k = 0; k < n; ++k) {
    const float low = a1[k] < b1[k] ? a1[k] : b1[k], high = a1[k] < b1[k] ? b1[k] : a1[k];
    const float seconds = a2[k] < b2[k] ? a2[k] : b2[k];
    o1[k] = low;
    o2[k] = high < seconds ? high : seconds;
  }
}

// For each cell the depth beyond which a point in it is hidden: of the second smallest depth in each of four
// quadrants, the third smallest. A quadrant is three cells by two: a cell in the same row or column belongs
// to one quadrant, the cell itself to none.
std::vector<float> HidingDepths(const DepthGrid& cells, int columns, int rows) {
  const int s = cells.stride;
  DepthGrid wide2(columns, rows), wide3(columns, rows), flat(columns, rows), tall(columns, rows);
  Merge(cells, cells, 1, &wide2);  // the cell and its right neighbour
  Merge(wide2, cells, 2, &wide3);  // and the next
  Merge(wide3, wide3, s, &flat);   // 3 wide, 2 high, from its upper left cell
  Merge(wide2, wide2, s, &tall);
  DepthGrid tall3(columns, rows);
  Merge(tall, wide2, 2 * s, &tall3);  // 2 wide, 3 high
  std::vector<float> hiding(cells.first.size(), kNone);
  const float* const two = flat.second.data();
  const float* const three = tall3.second.data();
  for (int r = kReach; r < rows + kReach; ++r) {
    for (int c = kReach; c < columns + kReach; ++c) {
      const int k = r * s + c;
      const float a = two[k - 2 * s - 2], b = three[k - 2 * s + 1], d = two[k + s], e = three[k - 2];
      // Third smallest of four: the smaller of the two pairs' larger ones, unless a pair lies below the
      // other.
      const float low1 = std::min(a, b), high1 = std::max(a, b), low2 = std::min(d, e),
                  high2 = std::max(d, e);
      hiding[k] = std::min(std::max(high1, low2), std::max(high2, low1));
    }
  }
  return hiding;
}

}  // namespace

void RemoveOccluded(const Camera& camera, double margin_px, std::vector<ProjectedPoint>* points) {
  const auto margin = static_cast<float>(margin_px);
  const int columns = static_cast<int>((static_cast<float>(camera.width) + 2 * margin) / kCell) + 2;
  const int rows = static_cast<int>((static_cast<float>(camera.height) + 2 * margin) / kCell) + 2;
  DepthGrid cells(columns, rows);
  const auto cell_of = [&](const ProjectedPoint& p) {
    return (static_cast<int>((p.pixel.y() + margin) * (1 / kCell)) + kReach) * cells.stride +
           static_cast<int>((p.pixel.x() + margin) * (1 / kCell)) + kReach;
  };
  for (const ProjectedPoint& p : *points) {
    const int k = cell_of(p);
    const float first = cells.first[k];
    cells.second[k] = std::min(cells.second[k], std::max(first, p.depth));
    cells.first[k] = std::min(first, p.depth);
  }
  const std::vector<float> hiding = HidingDepths(cells, columns, rows);
  ProjectedPoint* kept = points->data();
  for (const ProjectedPoint& p : *points) {  // no branch: hard to predict
    const bool hidden = hiding[cell_of(p)] < std::min(p.depth * (1 - kRelative), p.depth - kAbsolute);
    *kept = p;
    kept += hidden ? 0 : 1;
  }
  points->resize(static_cast<std::size_t>(kept - points->data()));
}

}  // namespace evit
