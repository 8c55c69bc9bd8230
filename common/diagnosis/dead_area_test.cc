#include "common/diagnosis/dead_area.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace evit::diagnosis {
namespace {

constexpr int kWidth = 160, kHeight = 120;

// Short edges that move all over the sensor, but for what `silent` says.
EventCensus Census(int n_edges, unsigned seed, const std::function<bool(int, int)>& silent) {
  std::mt19937 rng(seed);
  EventCensus census(kWidth, kHeight);
  EventArray events;
  for (Utime t = 0; t < n_edges; ++t) {
    const double turn = 1e-3 * static_cast<double>(rng() % 3142);
    const auto x0 = static_cast<int>(rng() % kWidth), y0 = static_cast<int>(rng() % kHeight);
    for (int k = 0; k < 12; ++k) {
      const int x = x0 + static_cast<int>(k * std::cos(turn)), y = y0 + static_cast<int>(k * std::sin(turn));
      if (x < 0 || x >= kWidth || y >= kHeight || silent(x, y)) continue;
      events.push_back(t, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), k % 2);
    }
  }
  census.Add(events);
  return census;
}

TEST(DeadArea, ColumnsRowsAndBlocksAreFound) {
  const auto found = [](const std::function<bool(int, int)>& silent) {
    return FindDeadArea(Census(2000, 1, silent));
  };
  const auto columns = found([](int x, int) { return x >= 40 && x < 48; });
  ASSERT_TRUE(columns);
  EXPECT_EQ(columns->left, 40);
  EXPECT_EQ(columns->width(), 8);
  EXPECT_EQ(columns->height(), kHeight);
  const auto rows = found([](int, int y) { return y >= 110; });
  ASSERT_TRUE(rows);
  EXPECT_EQ(rows->top, 110);
  EXPECT_EQ(rows->width(), kWidth);
  const auto block = found([](int x, int y) { return x >= 30 && x < 70 && y >= 20 && y < 50; });
  ASSERT_TRUE(block);
  EXPECT_EQ(block->right, 69);
  EXPECT_EQ(block->bottom, 49);
  EXPECT_EQ(CheckDeadArea(Census(2000, 1, [](int x, int) { return x < 20; })).severity, Severity::kWarning);
}

// A dark screen, upright in the image, that a hand moves about: no edge comes as far as its middle, and only
// the widest of its swings reach the rim of that.
TEST(DeadArea, AScreenIsNone) {
  for (const int reach : {6, 12, 25}) {
    EventCensus census(kWidth, kHeight);
    EventArray events;
    int x = 0, y = 0;
    for (Utime t = 0; t < 10'000; ++t) {
      const double s = 1e-3 * static_cast<double>(t);
      const auto put = [&](int u, int v) {
        events.push_back(t, static_cast<std::uint16_t>(u), static_cast<std::uint16_t>(v), t % 2);
      };
      // An edge makes events where it moves on.
      const int x_now = static_cast<int>(
                    std::lround(reach * (0.6 * std::sin(3 * s) + 0.4 * std::sin(7.3 * s + 1)))),
                y_now = static_cast<int>(
                    std::lround(reach * (0.5 * std::sin(4.1 * s) + 0.5 * std::sin(9.7 * s + 2))));
      for (int k = 0; k <= 70 && x_now != x; ++k)
        put(40 + x_now, 25 + y_now + k), put(115 + x_now, 25 + y_now + k);
      for (int k = 0; k <= 75 && y_now != y; ++k)
        put(40 + x_now + k, 25 + y_now), put(40 + x_now + k, 95 + y_now);
      x = x_now, y = y_now;
    }
    census.Add(events);
    EXPECT_FALSE(FindDeadArea(census)) << reach;
  }
}

// What is plain in a scene has no straight edges; nor has a scene with few events.
TEST(DeadArea, PlainPartsOfASceneAreNone) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    for (const int n : {50, 300, 2000}) {
      const auto disc = [](int x, int y) { return std::hypot(x - 60, y - 50) < 35; };
      EXPECT_FALSE(FindDeadArea(Census(n, seed, disc))) << seed << ", " << n;
      const auto corner = [](int x, int y) { return x + 2 * y < 120; };
      EXPECT_FALSE(FindDeadArea(Census(n, seed, corner))) << seed << ", " << n;
      EXPECT_FALSE(FindDeadArea(Census(n, seed, [](int, int) { return false; }))) << seed << ", " << n;
    }
  }
}

}  // namespace
}  // namespace evit::diagnosis
