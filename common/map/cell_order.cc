#include "common/map/cell_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/simd/lanes.h"

namespace evit {
namespace {

constexpr int kAxisBits = 21;
constexpr double kFarthest = (1 << (kAxisBits - 1)) - 2;  // cells from the origin

EVIT_MULTIVERSION void FindCells(const float* coordinates, std::size_t n, double inverse_side,
                                 std::int32_t* cells) {
  for (std::size_t k = 0; k < n; ++k) {
    const double cell = coordinates[k] * inverse_side;
    const double low = cell < kFarthest ? cell : kFarthest;
    cells[k] = static_cast<std::int32_t>(std::floor(low > -kFarthest ? low : -kFarthest));
  }
}

}  // namespace

CellOrder::CellOrder(const std::vector<Eigen::Vector3f>& points, double side) : inverse_side_(1 / side) {
  if (points.empty()) return;
  std::vector<std::int32_t> cells(3 * points.size());
  FindCells(points.front().data(), cells.size(), inverse_side_, cells.data());
  const auto cell = [&cells](std::size_t k) {
    return Cell{cells[3 * k], cells[3 * k + 1], cells[3 * k + 2]};
  };
  least_ = cell(0);
  for (std::size_t k = 0; k < cells.size(); ++k)
    least_[k % 3] = std::min<std::int64_t>(least_[k % 3], cells[k]);
  places_.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    places_.push_back({KeyOf(cell(k)), static_cast<std::int32_t>(k)});
  Sort();
}

std::size_t CellOrder::EndOfCell(std::size_t k) const {
  const std::uint64_t key = places_[k].key;
  while (k < places_.size() && places_[k].key == key) ++k;
  return k;
}

CellOrder::Cell CellOrder::CellOf(const Eigen::Vector3f& p) const {
  std::int32_t cell[3];
  FindCells(p.data(), 3, inverse_side_, cell);
  return {cell[0], cell[1], cell[2]};
}

std::uint64_t CellOrder::KeyOf(const Cell& cell) const {
  std::uint64_t key = 0;
  for (int k = 0; k < 3; ++k) key = (key << kAxisBits) | static_cast<std::uint64_t>(cell[k] - least_[k] + 1);
  return key;
}

// By digits, of which a map of a room has three: half a million points at a time, of which a comparison says
// little.
void CellOrder::Sort() {
  constexpr int kDigitBits = 11;
  constexpr std::uint64_t kMask = (1 << kDigitBits) - 1;
  std::uint64_t differing = 0;
  for (const Place& place : places_) differing |= place.key ^ places_.front().key;
  std::vector<Place> sorted(places_.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (int shift = axis * kAxisBits; shift < (axis + 1) * kAxisBits; shift += kDigitBits) {
      if ((differing >> shift & kMask) == 0) continue;
      std::array<std::size_t, kMask + 2> begin{};
      for (const Place& place : places_) ++begin[(place.key >> shift & kMask) + 1];
      std::partial_sum(begin.begin(), begin.end(), begin.begin());
      for (const Place& place : places_) sorted[begin[place.key >> shift & kMask]++] = place;
      std::swap(places_, sorted);
    }
  }
}

}  // namespace evit
