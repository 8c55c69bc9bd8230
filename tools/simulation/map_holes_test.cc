#include "tools/simulation/map_holes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tools/simulation/random.h"

namespace evit::simulation {
namespace {

PointMap Cube(std::size_t n) {
  Random random(5);
  PointMap map;
  for (std::size_t i = 0; i < n; ++i)
    map.points.emplace_back(random.Uniform(0, 3), random.Uniform(0, 3), random.Uniform(0, 3));
  return map;
}

TEST(CutHoles, TakesTheShareInBalls) {
  const PointMap whole = Cube(20'000);
  PointMap map = whole;
  CutHoles({0.5, 0.6}, 1, &map);
  EXPECT_EQ(map.points.size(), 10'000U);
  // What is left is in order and untouched.
  std::vector<Eigen::Vector3f> gone;
  std::size_t k = 0;
  for (const Eigen::Vector3f& p : whole.points) {
    if (k < map.points.size() && map.points[k] == p) {
      ++k;
    } else {
      gone.push_back(p);
    }
  }
  EXPECT_EQ(k, map.points.size());
  // Points at random would leave a neighbour within 10 cm of most that are gone; balls do not.
  int lonely = 0;
  for (std::size_t i = 0; i < gone.size(); i += 50) {
    lonely += std::none_of(map.points.begin(), map.points.end(),
                           [&](const Eigen::Vector3f& p) { return (p - gone[i]).norm() < 0.1F; });
  }
  EXPECT_GT(lonely, static_cast<int>(gone.size() / 50 / 3));
}

TEST(CutHoles, IsSeededAndMayTakeNothing) {
  PointMap a = Cube(5'000), b = a, c = a, d = a;
  CutHoles({0.3, 0.5}, 7, &a);
  CutHoles({0.3, 0.5}, 7, &b);
  CutHoles({0.3, 0.5}, 8, &c);
  CutHoles({}, 7, &d);
  EXPECT_EQ(a.points, b.points);
  EXPECT_NE(a.points, c.points);
  EXPECT_EQ(d.points.size(), 5'000U);
}

}  // namespace
}  // namespace evit::simulation
