#include "common/map/cell_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>

namespace evit {
namespace {

std::vector<Eigen::Vector3f> Cloud(std::size_t n, float extent) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> uniform(-extent, extent);
  std::vector<Eigen::Vector3f> points;
  for (std::size_t k = 0; k < n; ++k) points.emplace_back(uniform(random), uniform(random), uniform(random));
  return points;
}

// Compares with a sort of cells and indices.
void ExpectSorted(const std::vector<Eigen::Vector3f>& points, double side) {
  const CellOrder order(points, side);
  ASSERT_EQ(order.size(), points.size());
  std::vector<std::tuple<CellOrder::Cell, std::int32_t>> expected;
  for (std::size_t k = 0; k < points.size(); ++k)
    expected.emplace_back(order.CellOf(points[k]), static_cast<std::int32_t>(k));
  std::sort(expected.begin(), expected.end());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& [cell, index] = expected[k];
    ASSERT_EQ(order[k].index, index);
    ASSERT_EQ(order[k].key, order.KeyOf(cell));
  }
}

TEST(CellOrder, SortsByCellThenIndex) {
  ExpectSorted(Cloud(5000, 3), 0.5);    // many points in a cell, cells on both sides of the origin
  ExpectSorted(Cloud(5000, 90), 0.02);  // thousands of cells along each axis
}

TEST(CellOrder, KeysOfNeighboursAlongZAreNeighbours) {
  const CellOrder order(Cloud(100, 1), 0.1);
  EXPECT_EQ(order.KeyOf({0, 3, 5}) + 1, order.KeyOf({0, 3, 6}));
  EXPECT_LT(order.KeyOf({0, 3, 5}), order.KeyOf({0, 4, -5}));
  EXPECT_LT(order.KeyOf({0, 4, -5}), order.KeyOf({1, -5, -5}));
}

TEST(CellOrder, ACellEndsWhereTheNextBegins) {
  const CellOrder order({{0.1F, 0, 0}, {2, 0, 0}, {0.2F, 0, 0}}, 1);
  EXPECT_EQ(order.EndOfCell(0), 2U);
  EXPECT_EQ(order.EndOfCell(2), 3U);
}

TEST(CellOrder, FarPointsShareTheLastCell) {
  const std::vector<Eigen::Vector3f> points = {{1e30F, 0, 0}, {0, 0, 0}, {1e20F, 0, 0}, {-1e30F, 0, 0}};
  ExpectSorted(points, 0.25);
  EXPECT_EQ(CellOrder(points, 0.25).EndOfCell(2), 4U);
}

TEST(CellOrder, NoPointsAreNoCells) { EXPECT_EQ(CellOrder({}, 1).size(), 0U); }

}  // namespace
}  // namespace evit
