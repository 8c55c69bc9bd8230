#include "tools/formats/import/counter_wrap.h"

#include <gtest/gtest.h>

#include <vector>

namespace evit::formats {
namespace {

std::vector<Utime> Continued(const std::vector<Utime>& stamps) {
  CounterWrap wrap;
  std::vector<Utime> out;
  for (const Utime t : stamps) out.push_back(wrap.Continue(t));
  return out;
}

TEST(CounterWrap, AnyCounterGoesOnTwice) {
  for (const int bits : {24, 31, 32}) {
    const Utime n = Utime{1} << bits;
    EXPECT_EQ(Continued({n / 2, n - 7, n - 1, 3, n / 2, n - 2, 5}),
              (std::vector<Utime>{n / 2, n - 7, n - 1, n + 3, n + n / 2, 2 * n - 2, 2 * n + 5}))
        << bits;
  }
}

TEST(CounterWrap, ACounterWithSignGoesOn) {
  const Utime n = Utime{1} << 31;
  EXPECT_EQ(Continued({n - 3, -n + 2, -n + 9}), (std::vector<Utime>{n - 3, n + 2, n + 9}));
}

TEST(CounterWrap, WhatComesLateOverAWrapGoesBackBeforeIt) {
  const Utime n = Utime{1} << 24;
  EXPECT_EQ(Continued({n - 9, 4, n - 5, 6}), (std::vector<Utime>{n - 9, n + 4, n - 5, n + 6}));
}

TEST(CounterWrap, StampsThatAreWrongAreNoWraps) {
  const Utime date = 1'700'000'000'000'000;
  for (const std::vector<Utime>& stamps :
       std::vector<std::vector<Utime>>{{10, 1'000'000'000'000, 20},
                                       {date, 5, date + 10},
                                       {5, date, 10},
                                       {Utime{1} << 30, 3},
                                       {(Utime{1} << 32) - 5, Utime{1} << 31, (Utime{1} << 31) + 1}}) {
    EXPECT_EQ(Continued(stamps), stamps);
  }
}

}  // namespace
}  // namespace evit::formats
