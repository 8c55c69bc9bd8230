#include "tools/mapping/map_compare.h"

#include <gtest/gtest.h>

namespace evit::mapping {
namespace {

// A path through one of the points: the others' shares are what they are.
TEST(DistanceBetween, APointOnThePathHasNoShare) {
  PointMap map, reference;
  map.points = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  reference.points = {{0, 0, 0}, {2, 0, 0.01F}, {0, 2, 0.01F}};
  const PathDistance path({{1, SE3()}});
  const MapDistance distance = DistanceBetween(map, reference, &path, 0.02);
  EXPECT_EQ(distance.points, 3U);
  EXPECT_NEAR(distance.median_m, 0.01, 1e-6);
  EXPECT_NEAR(distance.median_share, 0.005, 1e-6);
}

}  // namespace
}  // namespace evit::mapping
