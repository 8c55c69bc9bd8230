#include "common/map/occlusion.h"

#include <algorithm>
#include <limits>

namespace evit {
namespace {

constexpr float kCell = 8;          // pixels
constexpr int kReach = 2;           // cells around
constexpr float kRelative = 0.10F;  // a nearer surface is nearer by this share of the depth
constexpr float kAbsolute = 0.05F;  // and by this much, m
constexpr int kQuadrants = 3;       // of 4, that must hold nearer points
constexpr int kEvidence = 2;        // points per quadrant

constexpr float kNone = std::numeric_limits<float>::max();

struct Nearest {
  float first = kNone, second = kNone;  // m
};

// Smallest depth within kReach cells around each cell.
std::vector<float> NeighbourhoodMinimum(const std::vector<Nearest>& buffer, int columns, int rows) {
  std::vector<float> across(buffer.size(), kNone), around(buffer.size(), kNone);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      float& value = across[static_cast<std::size_t>(y) * columns + x];
      for (int k = std::max(0, x - kReach); k <= std::min(columns - 1, x + kReach); ++k) {
        value = std::min(value, buffer[static_cast<std::size_t>(y) * columns + k].first);
      }
    }
  }
  for (int y = 0; y < rows; ++y) {
    for (int k = std::max(0, y - kReach); k <= std::min(rows - 1, y + kReach); ++k) {
      for (int x = 0; x < columns; ++x) {
        float& value = around[static_cast<std::size_t>(y) * columns + x];
        value = std::min(value, across[static_cast<std::size_t>(k) * columns + x]);
      }
    }
  }
  return around;
}

}  // namespace

void RemoveOccluded(const Camera& camera, double margin_px, std::vector<ProjectedPoint>* points) {
  // Per cell the second smallest depth: two points must agree before a cell counts as a nearer surface.
  const auto margin = static_cast<float>(margin_px);
  const int columns = static_cast<int>((static_cast<float>(camera.width) + 2 * margin) / kCell) + 2;
  const int rows = static_cast<int>((static_cast<float>(camera.height) + 2 * margin) / kCell) + 2;
  std::vector<Nearest> buffer(static_cast<std::size_t>(columns) * rows);
  const auto column_of = [&](const ProjectedPoint& p) {
    return static_cast<int>((p.pixel.x() + margin) / kCell);
  };
  const auto row_of = [&](const ProjectedPoint& p) {
    return static_cast<int>((p.pixel.y() + margin) / kCell);
  };
  for (const ProjectedPoint& p : *points) {
    Nearest& cell = buffer[static_cast<std::size_t>(row_of(p)) * columns + column_of(p)];
    if (p.depth < cell.first) {
      cell.second = cell.first;
      cell.first = p.depth;
    } else {
      cell.second = std::min(cell.second, p.depth);
    }
  }
  const std::vector<float> nearest = NeighbourhoodMinimum(buffer, columns, rows);
  const auto hidden = [&](const ProjectedPoint& p) {
    const float limit = std::min(p.depth * (1 - kRelative), p.depth - kAbsolute);
    const int c = column_of(p), r = row_of(p);
    if (nearest[static_cast<std::size_t>(r) * columns + c] >= limit) return false;  // most points end here
    int count[4] = {0, 0, 0, 0};
    for (int y = std::max(0, r - kReach); y <= std::min(rows - 1, r + kReach); ++y) {
      for (int x = std::max(0, c - kReach); x <= std::min(columns - 1, c + kReach); ++x) {
        const Nearest& cell = buffer[static_cast<std::size_t>(y) * columns + x];
        const int near = (cell.first < limit ? 1 : 0) + (cell.second < limit ? 1 : 0);
        if (near == 0) continue;
        // A cell on an axis speaks for both quadrants beside it; the own cell for none: it has no side.
        if (x <= c && y < r) count[0] += near;
        if (x > c && y <= r) count[1] += near;
        if (x >= c && y > r) count[2] += near;
        if (x < c && y >= r) count[3] += near;
      }
    }
    return std::count_if(count, count + 4, [](int n) { return n >= kEvidence; }) >= kQuadrants;
  };
  points->erase(std::remove_if(points->begin(), points->end(), hidden), points->end());
}

}  // namespace evit
