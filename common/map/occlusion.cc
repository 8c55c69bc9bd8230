#include "common/map/occlusion.h"

#include <algorithm>
#include <array>
#include <limits>

namespace evit {
namespace {

constexpr float kCell = 8;          // pixels
constexpr int kReach = 2;           // cells around
constexpr float kRelative = 0.10F;  // a nearer surface is nearer by this share of the depth
constexpr float kAbsolute = 0.05F;  // and by this much, m
constexpr int kQuadrants = 3;       // of 4, that must hold nearer points

constexpr float kNone = std::numeric_limits<float>::max();

// The two smallest depths of a set, m. Two points must agree before a cell or quadrant counts as a nearer
// surface.
struct Nearest {
  float first = kNone, second = kNone;
  void Add(float depth) {
    second = std::min(second, std::max(first, depth));
    first = std::min(first, depth);
  }
};

// Per cell the depth beyond which a point in it is hidden: whether it is depends on the quadrants' second
// smallest depths alone, so that the third smallest of those is the threshold for every point of the cell.
std::vector<float> HidingDepths(const std::vector<Nearest>& buffer, int columns, int rows) {
  std::vector<float> hiding(buffer.size(), kNone);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      Nearest quadrants[4];
      for (int y = std::max(0, r - kReach); y <= std::min(rows - 1, r + kReach); ++y) {
        for (int x = std::max(0, c - kReach); x <= std::min(columns - 1, c + kReach); ++x) {
          const Nearest& cell = buffer[static_cast<std::size_t>(y) * columns + x];
          if (cell.first == kNone) continue;
          // A cell on an axis speaks for one quadrant; the own cell for none: it has no side.
          const int quadrant = x <= c && y < r   ? 0
                               : x > c && y <= r ? 1
                               : x >= c && y > r ? 2
                               : x < c && y >= r ? 3
                                                 : -1;
          if (quadrant < 0) continue;
          quadrants[quadrant].Add(cell.first);
          quadrants[quadrant].Add(cell.second);
        }
      }
      std::array<float, 4> second = {quadrants[0].second, quadrants[1].second, quadrants[2].second,
                                     quadrants[3].second};
      std::sort(second.begin(), second.end());
      hiding[static_cast<std::size_t>(r) * columns + c] = second[kQuadrants - 1];
    }
  }
  return hiding;
}

}  // namespace

void RemoveOccluded(const Camera& camera, double margin_px, std::vector<ProjectedPoint>* points) {
  const auto margin = static_cast<float>(margin_px);
  const int columns = static_cast<int>((static_cast<float>(camera.width) + 2 * margin) / kCell) + 2;
  const int rows = static_cast<int>((static_cast<float>(camera.height) + 2 * margin) / kCell) + 2;
  std::vector<Nearest> buffer(static_cast<std::size_t>(columns) * rows);
  const auto cell_of = [&](const ProjectedPoint& p) {
    return static_cast<std::size_t>((p.pixel.y() + margin) / kCell) * columns +
           static_cast<std::size_t>((p.pixel.x() + margin) / kCell);
  };
  for (const ProjectedPoint& p : *points) buffer[cell_of(p)].Add(p.depth);
  const std::vector<float> hiding = HidingDepths(buffer, columns, rows);
  const auto hidden = [&](const ProjectedPoint& p) {
    return hiding[cell_of(p)] < std::min(p.depth * (1 - kRelative), p.depth - kAbsolute);
  };
  points->erase(std::remove_if(points->begin(), points->end(), hidden), points->end());
}

}  // namespace evit
