#include "common/map/occlusion.h"

#include <algorithm>
#include <limits>

#include "common/simd/lanes.h"

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

  void Add(std::int32_t cell, float depth) {
    const float nearest = first[cell];
    second[cell] = std::min(second[cell], std::max(nearest, depth));
    first[cell] = std::min(nearest, depth);
  }

  int stride;
  std::vector<float> first, second;
};

EVIT_MULTIVERSION void FindCells(const ProjectedPoint* points, std::size_t n, float margin, int stride,
                                 std::int32_t* __restrict cell) {
  for (std::size_t k = 0; k < n; ++k) {
    cell[k] = (static_cast<int>((points[k].pixel[1] + margin) * (1 / kCell)) + kReach) * stride +
              static_cast<int>((points[k].pixel[0] + margin) * (1 / kCell)) + kReach;
  }
}

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
  // Points come in the order of their places: successive ones show in the same cells. In two grids by turns
  // they do not wait for each other.
  DepthGrid cells(columns, rows), others(columns, rows);
  std::vector<std::int32_t> cell(points->size());
  FindCells(points->data(), points->size(), margin, cells.stride, cell.data());
  for (std::size_t k = 0; k < points->size(); ++k)
    (k % 2 == 0 ? cells : others).Add(cell[k], (*points)[k].depth);
  DepthGrid all(columns, rows);
  Merge(cells, others, 0, &all);
  const std::vector<float> hiding = HidingDepths(all, columns, rows);
  ProjectedPoint* kept = points->data();
  for (std::size_t k = 0; k < points->size(); ++k) {  // no branch: hard to predict
    const ProjectedPoint p = (*points)[k];
    const bool hidden = hiding[cell[k]] < std::min(p.depth * (1 - kRelative), p.depth - kAbsolute);
    *kept = p;
    kept += hidden ? 0 : 1;
  }
  points->resize(static_cast<std::size_t>(kept - points->data()));
}

}  // namespace evit
