#include "common/map/spread_subset.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "common/simd/lanes.h"

namespace evit {
namespace {

constexpr float kTile = 32;  // pixels

// What a draw is decided by: random number, then id (no two points tie).
struct Draw {
  std::uint32_t number;
  std::int32_t id, place;
  bool operator<(const Draw& other) const {
    return number != other.number ? number < other.number : id < other.id;
  }
};

// For each point its tile, and a random number: the finalizer of MurmurHash3, of 32 bits so that several fit
// a vector.
EVIT_MULTIVERSION void NumberPoints(const ProjectedPoint* points, std::size_t n, float margin,
                                    std::int32_t columns, std::uint32_t seed, std::int32_t* __restrict tile,
                                    std::uint32_t* __restrict number) {
  for (std::size_t k = 0; k < n; ++k) {
    const ProjectedPoint& p = points[k];
    tile[k] = static_cast<std::int32_t>((p.pixel[1] + margin) * (1 / kTile)) * columns +
              static_cast<std::int32_t>((p.pixel[0] + margin) * (1 / kTile));
    std::uint32_t x = static_cast<std::uint32_t>(p.id) ^ seed;
    x = (x ^ (x >> 16)) * 0x85ebca6bU;
    x = (x ^ (x >> 13)) * 0xc2b2ae35U;
    number[k] = x ^ (x >> 16);
  }
}

// The points that may be drawn, tile by tile.
struct Draws {
  std::vector<Draw> list;
  std::vector<std::int32_t> begin;  // of each tile in it, and the end

  std::size_t Count(std::size_t tile) const {
    return static_cast<std::size_t>(begin[tile + 1] - begin[tile]);
  }
};

// Those whose number lies within the bound of their tile (`tile`, `number`: of each point).
Draws DrawPoints(const std::vector<ProjectedPoint>& points, const std::vector<std::int32_t>& tile,
                 const std::vector<std::uint32_t>& number, const std::vector<std::uint32_t>& bound) {
  // Found in one go over all of them, without a branch, which would be hard to predict.
  const std::unique_ptr<Draw[]> drawn(new Draw[points.size() + 1]);
  std::size_t n = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    drawn[n] = {number[k], points[k].id, static_cast<std::int32_t>(k)};
    n += number[k] <= bound[tile[k]] ? 1 : 0;
  }
  Draws draws;
  draws.begin.assign(bound.size() + 1, 0);
  for (std::size_t d = 0; d < n; ++d) ++draws.begin[tile[drawn[d].place] + 1];
  std::partial_sum(draws.begin.begin(), draws.begin.end(), draws.begin.begin());
  draws.list.resize(n);
  std::vector<std::int32_t> at(draws.begin.begin(), draws.begin.end() - 1);
  for (std::size_t d = 0; d < n; ++d) draws.list[at[tile[drawn[d].place]]++] = drawn[d];
  return draws;
}

// The largest quota with which the tiles together stay within the budget.
std::size_t Quota(const std::vector<std::int32_t>& counts, std::size_t budget) {
  const auto taken = [&](std::size_t quota) {
    std::size_t sum = 0;
    for (const std::int32_t n : counts) sum += std::min<std::size_t>(n, quota);
    return sum;
  };
  std::size_t quota = 0, above = budget + 1;
  while (above - quota > 1) {
    const std::size_t middle = (quota + above) / 2;
    (taken(middle) <= budget ? quota : above) = middle;
  }
  return quota;
}

}  // namespace

std::uint64_t Mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

std::vector<std::int32_t> SpreadSubset(const std::vector<ProjectedPoint>& points, const ScreenArea& area,
                                       std::size_t budget, std::uint64_t seed) {
  std::vector<std::int32_t> places;
  if (points.size() <= budget) {
    places.resize(points.size());
    std::iota(places.begin(), places.end(), 0);
    return places;
  }
  const auto margin = static_cast<float>(area.margin_px);
  const int columns = static_cast<int>((static_cast<float>(area.width) + 2 * margin) / kTile) + 2;
  const int rows = static_cast<int>((static_cast<float>(area.height) + 2 * margin) / kTile) + 2;
  std::vector<std::int32_t> tile(points.size()), counts(static_cast<std::size_t>(columns) * rows, 0);
  std::vector<std::uint32_t> number(points.size());
  NumberPoints(points.data(), points.size(), margin, columns, static_cast<std::uint32_t>(Mix(seed)),
               tile.data(), number.data());
  for (const std::int32_t t : tile) ++counts[t];
  const std::size_t quota = Quota(counts, budget);

  // A point whose number lies far above its tile's quota cannot be drawn: little more is looked at closely
  // than what is returned. The bound is four standard deviations above what the quota needs; should a tile
  // come out short (it does not in practice), its points are all taken into the draw.
  constexpr std::uint32_t kAll = ~std::uint32_t{0};
  std::vector<std::uint32_t> bound(counts.size());
  for (std::size_t t = 0; t < counts.size(); ++t) {
    const double expected = static_cast<double>(quota) + 1;
    const double share = (expected + 4 * std::sqrt(expected) + 4) / std::max(counts[t], 1);
    bound[t] = share >= 1 ? kAll : static_cast<std::uint32_t>(share * 0x1p32);
  }
  Draws draws = DrawPoints(points, tile, number, bound);
  for (std::size_t t = 0; t < counts.size(); ++t) {
    if (draws.Count(t) >= std::min<std::size_t>(counts[t], quota + 1)) continue;
    std::fill(bound.begin(), bound.end(), kAll);
    draws = DrawPoints(points, tile, number, bound);
    break;
  }

  std::vector<Draw> next;  // each rich tile's first point beyond the quota
  places.reserve(budget);
  std::vector<Draw> ordered;
  for (std::size_t t = 0; t < counts.size(); ++t) {
    const auto begin = draws.list.begin() + draws.begin[t], end = draws.list.begin() + draws.begin[t + 1];
    if (draws.Count(t) <= quota) {
      for (auto k = begin; k != end; ++k) places.push_back(k->place);
      continue;
    }
    ordered.assign(begin, end);
    const auto first_left = ordered.begin() + static_cast<std::ptrdiff_t>(quota);
    std::nth_element(ordered.begin(), first_left, ordered.end());
    next.push_back(*first_left);
    for (auto k = begin; k != end; ++k) {
      if (*k < *first_left) places.push_back(k->place);
    }
  }
  // Points that still fit: each from another of the tiles with more than the quota.
  std::sort(next.begin(), next.end());
  for (std::size_t k = 0; places.size() < budget && k < next.size(); ++k) places.push_back(next[k].place);
  return places;
}

}  // namespace evit
