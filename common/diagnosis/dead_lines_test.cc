#include "common/diagnosis/dead_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <random>

namespace evit::diagnosis {
namespace {

constexpr int kLineWidth = 160, kLineHeight = 120;

// Events anywhere but where `silent` says, more of them to the right.
EventCensus EventsBut(const std::function<bool(int, int)>& silent) {
  std::mt19937 rng(1);
  EventCensus census(kLineWidth, kLineHeight);
  EventArray events;
  for (Utime t = 0; t < 200'000; ++t) {
    const auto x = static_cast<int>(std::max(rng() % kLineWidth, rng() % kLineWidth)),
               y = static_cast<int>(rng() % kLineHeight);
    if (!silent(x, y))
      events.push_back(t, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), t % 2);
  }
  census.Add(events);
  return census;
}

TEST(DeadLines, RowsAndColumnsAreCounted) {
  const DeadLines dead =
      FindDeadLines(EventsBut([](int x, int y) { return x == 100 || x == 120 || (y >= 40 && y < 43); }));
  EXPECT_EQ(dead.columns, 2);
  EXPECT_EQ(dead.first_column, 100);
  EXPECT_EQ(dead.rows, 3);
  EXPECT_EQ(dead.first_row, 40);
}

// Nothing dead: all fire, a plain part that fades in over some pixels, a smaller sensor, a hot pixel beside.
TEST(DeadLines, WhatFadesOrEndsIsNone) {
  const auto none = [](const std::function<bool(int, int)>& silent) {
    const DeadLines dead = FindDeadLines(EventsBut(silent));
    return dead.rows + dead.columns == 0;
  };
  EXPECT_TRUE(none([](int, int) { return false; }));
  EXPECT_TRUE(none([](int x, int y) { return x >= 150 || y < 20; }));
  EXPECT_TRUE(none([](int x, int y) {  // around row 60, 8 pixels wide and 6 of fading on both sides
    const int away = std::abs(y - 60) - 4;
    return away < 6 && (x * 7919 + y * 104729) % 6 >= std::max(0, away);
  }));
}

TEST(DeadLines, OneLineIsNoFinding) {
  EXPECT_EQ(CheckDeadLines(EventsBut([](int x, int) { return x == 100; })).severity, Severity::kGood);
  EXPECT_EQ(CheckDeadLines(EventsBut([](int x, int) { return x == 100 || x == 101; })).severity,
            Severity::kWarning);
}

TEST(DeadLines, ManyAreACameraThatSkipsPixels) {
  EXPECT_EQ(CheckDeadLines(EventsBut([](int x, int y) { return x % 2 == 1 || y % 2 == 1; })).severity,
            Severity::kError);
}

}  // namespace
}  // namespace evit::diagnosis
