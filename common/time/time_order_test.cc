#include "common/time/time_order.h"

#include <gtest/gtest.h>

#include <random>

namespace evit {
namespace {

struct Stamped {
  Utime t;
  int id;
};

std::vector<Stamped> Regular(int n, Utime step) {
  std::vector<Stamped> items;
  for (int k = 0; k < n; ++k) items.push_back({step * k, k});
  return items;
}

std::vector<int> Ids(const std::vector<Stamped>& items) {
  std::vector<int> ids;
  for (const Stamped& item : items) ids.push_back(item.id);
  return ids;
}

TEST(TimeOrder, OrderedStampedsPassUnchanged) {
  TimeOrderCounts counts;
  const std::vector<Stamped> items = Regular(10'000, 37);
  EXPECT_EQ(Ids(InTimeOrder(items, {}, &counts)), Ids(items));
  EXPECT_EQ(counts.outlier + counts.late + counts.sorted, 0);
}

TEST(TimeOrder, OneStampAheadIsDroppedAndNothingBehindIt) {
  for (const Utime ahead : {Utime{1'000'000}, Utime{500'000'000}, Utime{9'000'000'000'000'000}}) {
    for (const int at : {0, 1, 400, 998}) {
      std::vector<Stamped> items = Regular(1000, 500);
      items[at].t += ahead;
      TimeOrderCounts counts;
      const std::vector<Stamped> out = InTimeOrder(items, {}, &counts);
      EXPECT_EQ(out.size(), 999U) << ahead << " at " << at;
      EXPECT_EQ(counts.outlier, 1) << ahead << " at " << at;
      EXPECT_EQ(counts.late, 0) << ahead << " at " << at;
    }
  }
}

TEST(TimeOrder, StraysAtTheEndAndZerosAtTheBeginAreDropped) {
  std::vector<Stamped> items = Regular(1000, 500);
  for (Stamped& item : items) item.t += 1'642'661'138'000'000;
  items[0].t = items[1].t = 0;
  items[999].t += 3'600'000'000;
  TimeOrderCounts counts;
  EXPECT_EQ(InTimeOrder(items, {}, &counts).size(), 997U);
  EXPECT_EQ(counts.outlier, 3);
}

// An old row after the last one, as of two files appended: the last good one must not go with it.
TEST(TimeOrder, WhatIsTooLateCostsItselfOnly) {
  for (const Utime window : {0, 50'000}) {
    std::vector<Stamped> items = Regular(100, 60'000);
    items.push_back({510'000, 100});
    TimeOrderOptions options;
    options.window = window;
    options.strict = true;
    TimeOrderCounts counts;
    EXPECT_EQ(InTimeOrder(items, options, &counts).size(), 100U) << window;
    EXPECT_EQ(counts.late, 1) << window;
    EXPECT_EQ(counts.outlier, 0) << window;
  }
}

TEST(TimeOrder, GapsAreNoOutliers) {
  std::vector<Stamped> items = Regular(1000, 500);
  for (int k = 300; k < 1000; ++k) items[k].t += 10'000'000;
  for (int k = 990; k < 1000; ++k) items[k].t += 2'000'000;
  TimeOrderCounts counts;
  EXPECT_EQ(Ids(InTimeOrder(items, {}, &counts)), Ids(items));
  // One pose in ten seconds.
  EXPECT_EQ(InTimeOrder(Regular(20, 10'000'000), {}, &counts).size(), 20U);
}

TEST(TimeOrder, DisorderWithinTheWindowIsSorted) {
  std::vector<Stamped> items = Regular(20'000, 100);
  std::mt19937 rng(1);
  for (std::size_t begin = 0; begin < items.size(); begin += 400)  // shuffled within 40 ms
    std::shuffle(items.begin() + static_cast<std::ptrdiff_t>(begin),
                 items.begin() + static_cast<std::ptrdiff_t>(begin + 400), rng);
  TimeOrderCounts counts;
  EXPECT_EQ(Ids(InTimeOrder(items, {}, &counts)), Ids(Regular(20'000, 100)));
  EXPECT_EQ(counts.late, 0);
  EXPECT_GT(counts.sorted, 10'000);
}

TEST(TimeOrder, WhatIsLaterThanTheWindowIsDropped) {
  std::vector<Stamped> items = Regular(1000, 500);
  items[600].t -= 100'000;
  TimeOrderCounts counts;
  EXPECT_EQ(InTimeOrder(items, {}, &counts).size(), 999U);
  EXPECT_EQ(counts.late, 1);
}

TEST(TimeOrder, EqualStampsStayUnlessStrict) {
  std::vector<Stamped> items = Regular(100, 500);
  items[50].t = items[49].t;
  items[70].t = items[72].t;  // a repeat that has to be sorted first
  TimeOrderCounts counts;
  EXPECT_EQ(InTimeOrder(items, {}, &counts).size(), 100U);
  TimeOrderOptions strict;
  strict.strict = true;
  const std::vector<Stamped> out = InTimeOrder(items, strict, &counts);
  EXPECT_EQ(out.size(), 98U);
  EXPECT_EQ(counts.late, 2);
  for (std::size_t k = 1; k < out.size(); ++k) EXPECT_LT(out[k - 1].t, out[k].t);
}

}  // namespace
}  // namespace evit
