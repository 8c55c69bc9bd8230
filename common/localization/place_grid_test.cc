#include "common/localization/place_grid.h"

#include <gtest/gtest.h>

#include <random>

namespace evit {
namespace {

// Edges on walls of a room of 5 x 4 x 2.5 m, and along the floor's and the ceiling's rims; x low may be
// missing.
std::vector<EdgePoint> Room(bool all_walls) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> u(0, 1);
  std::vector<EdgePoint> edges;
  const auto add = [&](float x, float y, float z) {
    EdgePoint edge;
    edge.at = {x, y, z};
    edges.push_back(edge);
  };
  for (int k = 0; k < 300; ++k) {
    const float z = 2.5F * u(rng), x = 5 * u(rng), y = 4 * u(rng);
    add(x, 0, z), add(x, 4, z), add(5, y, z);
    if (all_walls) add(0, y, z);
    for (const float level : {0.0F, 2.5F}) add(x, 0, level), add(x, 4, level), add(0, y, level);
  }
  return edges;
}

bool AnyAt(const PlaceGrid& grid, const Eigen::Vector3f& at) {
  return std::any_of(grid.places.begin(), grid.places.end(),
                     [&](const Eigen::Vector3f& p) { return (p - at).norm() < grid.spacing; });
}

TEST(PlaceGrid, LiesWellBeyondASideWithoutAWall) {
  const PlaceGrid open = MakePlaceGrid(Room(false), {}), closed = MakePlaceGrid(Room(true), {});
  EXPECT_TRUE(AnyAt(open, {-1.8F, 2, 1.3F}));  // whence a camera saw the three walls
  EXPECT_FALSE(AnyAt(closed, {-1.8F, 2, 1.3F}));
  for (const PlaceGrid& grid : {open, closed}) {
    EXPECT_TRUE(AnyAt(grid, {2.5F, 2, 1.3F}));
    EXPECT_FALSE(AnyAt(grid, {7, 2, 1.3F}));
    EXPECT_FALSE(AnyAt(grid, {2.5F, -1.5F, 1.3F}));
  }
}

TEST(PlaceGrid, ARimIsNoWall) {
  EXPECT_EQ(ClosedSides(Room(false)), (std::array<bool, 4>{false, true, true, true}));
  EXPECT_EQ(ClosedSides(Room(true)), (std::array<bool, 4>{true, true, true, true}));
  EXPECT_EQ(ClosedSides({EdgePoint()}), (std::array<bool, 4>{false, false, false, false}));
}

TEST(PlaceGrid, NoMorePlacesThanAllowed) {
  PlaceGridOptions options;
  options.max_places = 500;
  const PlaceGrid grid = MakePlaceGrid(Room(false), options);
  EXPECT_LE(grid.places.size(), 500U);
  EXPECT_GT(grid.places.size(), 250U);
  EXPECT_GT(grid.spacing, 0.3);
}

}  // namespace
}  // namespace evit
