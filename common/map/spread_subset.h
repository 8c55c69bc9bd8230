#pragma once

#include <cstdint>
#include <vector>

#include "common/map/occlusion.h"

namespace evit {

/// The part of the plane that points may lie in: an image and `margin_px` around it.
struct ScreenArea {
  int width = 0, height = 0;  // pixels
  double margin_px = 0;
};

/// A seeded random subset of at most `budget` points, spread over the image: every tile of 32x32 pixels may
/// give the same number of points, and those it gives are drawn at random, so that a densely mapped spot does
/// not eat the budget. Returns places in `points`, tile by tile, ascending in each but for some last ones.
/// Which points are drawn depends on their ids and pixels and the seed alone, not on their order.
std::vector<std::int32_t> SpreadSubset(const std::vector<ProjectedPoint>& points, const ScreenArea& area,
                                       std::size_t budget, std::uint64_t seed);

/// SplitMix64: a well-mixed number for each x, without state.
std::uint64_t Mix(std::uint64_t x);

}  // namespace evit
