#include "common/map/near_points.h"

#include <gtest/gtest.h>

#include <random>

#include "common/simd/lanes.h"

namespace evit {
namespace {

TEST(NearPoints, AreThoseWithinTheRadiusInTheirOrder) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-1, 1);
  NearPoints near;
  for (const std::size_t n : {0U, 16U, 48U, 800U}) {
    Surroundings around;
    for (std::size_t k = 0; k < n; ++k) {
      around.Add(place(random), place(random), place(random), static_cast<float>(k % 3),
                 static_cast<std::int32_t>(k));
    }
    const float p[3] = {0.1F, -0.2F, 0.3F}, radius2 = 0.5F;
    const std::int32_t self = 7;
    FindNear(around, p, radius2, self, &near);
    std::size_t found = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const float dx = around.x[k] - p[0], dy = around.y[k] - p[1], dz = around.z[k] - p[2];
      if (!(dx * dx + (dy * dy + dz * dz) <= radius2)) continue;
      ASSERT_LT(found, near.room);
      EXPECT_EQ(near.dx[found], dx);
      EXPECT_EQ(near.dy[found], dy);
      EXPECT_EQ(near.dz[found], dz);
      EXPECT_EQ(near.count[found], around.index[k] == self ? 0 : around.count[k]);
      ++found;
    }
    EXPECT_TRUE(n < 48 || (found > 0 && found < n));
    EXPECT_EQ(near.room, (found + kLanes - 1) / kLanes * kLanes);
    for (std::size_t k = found; k < near.room; ++k) {
      EXPECT_EQ(near.count[k], 0);
      EXPECT_EQ(near.dx[k], 0);
    }
  }
}

}  // namespace
}  // namespace evit
