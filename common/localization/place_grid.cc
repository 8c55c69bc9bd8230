#include "common/localization/place_grid.h"

#include <algorithm>
#include <cmath>

namespace evit {
namespace {

constexpr double kRoomHeight = 2, kBeyondRoom = 0.2;  // m
constexpr double kCell = 0.5;                         // m: of a side, that holds edges or does not
constexpr float kWallDepth = 0.5F;  // m: edges so near to a side count as on it: furniture stands along walls
constexpr double kClosed = 0.25;    // share of the cells of a wall, without its rim, that hold edges at least

struct Box {
  Eigen::Vector3d low, high;
};

Box BoxOf(const std::vector<EdgePoint>& edges) {
  Box box{edges.front().at.cast<double>(), edges.front().at.cast<double>()};
  for (const EdgePoint& e : edges) {
    box.low = box.low.cwiseMin(e.at.cast<double>());
    box.high = box.high.cwiseMax(e.at.cast<double>());
  }
  return box;
}

// A side of the box across `axis`, in cells.
bool Closed(const std::vector<EdgePoint>& edges, const Box& box, int axis, bool high) {
  const int across = 1 - axis;
  const auto cells = [&](int a) {
    return static_cast<int>(std::min(1e3, (box.high[a] - box.low[a]) / kCell)) - 1;
  };
  const int columns = cells(across), rows = cells(2);
  if (columns < 1 || rows < 1) return false;
  std::vector<bool> held(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (const EdgePoint& e : edges) {
    const double depth = high ? box.high[axis] - e.at[axis] : e.at[axis] - box.low[axis];
    if (depth > kWallDepth) continue;
    // The first cell on each side is the rim.
    const int column = static_cast<int>((e.at[across] - box.low[across]) / kCell) - 1;
    const int row = static_cast<int>((e.at[2] - box.low[2]) / kCell) - 1;
    if (column >= 0 && column < columns && row >= 0 && row < rows) held[row * columns + column] = true;
  }
  return static_cast<double>(std::count(held.begin(), held.end(), true)) >=
         kClosed * static_cast<double>(held.size());
}

}  // namespace

std::array<bool, 4> ClosedSides(const std::vector<EdgePoint>& edges) {
  const Box box = BoxOf(edges);
  return {Closed(edges, box, 0, false), Closed(edges, box, 0, true), Closed(edges, box, 1, false),
          Closed(edges, box, 1, true)};
}

PlaceGrid MakePlaceGrid(const std::vector<EdgePoint>& edges, const PlaceGridOptions& options) {
  auto [low, high] = BoxOf(edges);
  const std::array<bool, 4> closed = ClosedSides(edges);
  for (int axis = 0; axis < 2; ++axis) {
    low[axis] -= closed[2 * axis] ? options.beyond : options.beyond_open;
    high[axis] += closed[2 * axis + 1] ? options.beyond : options.beyond_open;
  }
  // A map that is as high as a room has a floor and a ceiling: nobody looks from beyond.
  const double above = high.z() - low.z() < kRoomHeight ? options.beyond : kBeyondRoom;
  low.z() -= above;
  high.z() += above;
  const Eigen::Vector3d size = high - low;
  PlaceGrid grid;
  grid.spacing = std::max(options.spacing, std::cbrt(size.prod() / static_cast<double>(options.max_places)));
  Eigen::Vector3i n;
  for (;; grid.spacing *= 1.02) {
    for (int a = 0; a < 3; ++a) n[a] = static_cast<int>(std::min(1e6, size[a] / grid.spacing)) + 1;
    if (1.0 * n[0] * n[1] * n[2] <= static_cast<double>(options.max_places)) break;
  }
  const Eigen::Vector3d first = low + 0.5 * (size - grid.spacing * (n.array() - 1).matrix().cast<double>());
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x)
        grid.places.emplace_back((first + grid.spacing * Eigen::Vector3d(x, y, z)).cast<float>());
  return grid;
}

}  // namespace evit
