#include "common/overlap/pixel_set.h"

#include <gtest/gtest.h>

#include <random>

namespace evit {
namespace {

TEST(PixelSet, CountsEachPixelOnceAndNoneOutside) {
  PixelSet set(8, 6);
  set.Add(3, 2);
  set.Add(3, 2);
  set.Add(8, 2);
  set.Add(-1, 0);
  EXPECT_EQ(set.size(), 1);
  EXPECT_TRUE(set.Has(3, 2));
  EXPECT_FALSE(set.Has(2, 3));
  EXPECT_FALSE(set.Has(8, 2));
}

TEST(NearestPixel, FindsWhatASearchOfAllPixelsFinds) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> u(0, 39);
  PixelSet set(40, 40);
  for (int k = 0; k < 60; ++k) set.Add(static_cast<int>(u(rng)), static_cast<int>(u(rng)));
  const double reach = 4.3;
  const NearestPixel nearest(reach);
  for (int k = 0; k < 300; ++k) {
    const Eigen::Vector2d at(u(rng), u(rng));
    double best = reach;
    bool any = false;
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 40; ++x) {
        const double d = (Eigen::Vector2d(x, y) - at).norm();
        if (set.Has(x, y) && d <= best) best = d, any = true;
      }
    }
    Eigen::Vector2d offset;
    ASSERT_EQ(nearest.Find(set, at, &offset), any);
    if (any) {
      EXPECT_NEAR(offset.norm(), best, 1e-12);
    }
  }
}

}  // namespace
}  // namespace evit
