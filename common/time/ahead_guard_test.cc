#include "common/time/ahead_guard.h"

#include <gtest/gtest.h>

#include <vector>

namespace evit {
namespace {

struct Item {
  Utime t;
};

std::vector<Utime> Through(AheadGuard<Item>* guard, const std::vector<Utime>& stamps,
                           int* dropped = nullptr) {
  std::vector<Utime> out;
  const auto drop = [&](const Item&) {
    if (dropped != nullptr) ++*dropped;
  };
  const auto use = [&](const Item& item) { out.push_back(item.t); };
  for (const Utime t : stamps) guard->Push({t}, use, drop);
  guard->Flush(use);
  return out;
}

TEST(AheadGuard, OneInTheFutureIsDroppedAGapIsNot) {
  AheadGuard<Item> guard;
  int dropped = 0;
  EXPECT_EQ(Through(&guard, {0, 5'000, 500'005'000, 10'000, 15'000}, &dropped),
            (std::vector<Utime>{0, 5'000, 10'000, 15'000}));
  EXPECT_EQ(dropped, 1);
  AheadGuard<Item> gap;
  EXPECT_EQ(Through(&gap, {0, 5'000, 2'000'000, 2'005'000}, &dropped),
            (std::vector<Utime>{0, 5'000, 2'000'000, 2'005'000}));
  EXPECT_EQ(dropped, 1);
}

TEST(AheadGuard, WhatWaitsAtTheEndIsGoodAndTheFirstNeverWaits) {
  AheadGuard<Item> guard;
  EXPECT_EQ(Through(&guard, {9'000'000, 9'005'000, 20'000'000}),
            (std::vector<Utime>{9'000'000, 9'005'000, 20'000'000}));
  guard.Clear();
  EXPECT_EQ(Through(&guard, {5}), std::vector<Utime>{5});
}

TEST(AheadGuard, SlowStreamsPass) {
  AheadGuard<Item> guard;
  EXPECT_EQ(Through(&guard, {0, 1'000'000, 2'000'000, 3'000'000}).size(), 4U);
}

}  // namespace
}  // namespace evit
