#include "common/diagnosis/readout_limit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace evit::diagnosis {
namespace {

constexpr double kLimit = 1e6;  // events/s

// Two seconds whose rate swings between `low` and `high` events/s, each event by itself, through a readout
// that passes `limit` of them in a second and keeps the others waiting.
EventCensus ReadOut(double low, double high, double limit) {
  std::mt19937 rng(3);
  std::exponential_distribution<double> waiting(1);
  EventCensus census(64, 48);
  EventArray events;
  double t = 0, free_from = 0;  // us
  while (t < 2e6) {
    const double rate = low + (high - low) * std::pow(std::sin(t * 1e-6 * 3), 2);
    t += waiting(rng) * 1e6 / rate;
    const double leaves = std::max(t, free_from);
    if (leaves - t > 10'000) continue;
    free_from = leaves + 1e6 / limit;
    events.push_back(static_cast<Utime>(std::ceil(leaves)), static_cast<std::uint16_t>(rng() % 64),
                     static_cast<std::uint16_t>(rng() % 48), rng() % 2 != 0);
  }
  census.Add(events);
  return census;
}

TEST(ReadoutLimit, IsFoundWithItsRate) {
  const EventCensus census = ReadOut(2e5, 1.5e6, kLimit);
  const ReadoutLimit limit = FindReadoutLimit(census.bins());
  EXPECT_NEAR(limit.rate, kLimit, 0.01 * kLimit);
  EXPECT_GT(limit.seconds, 0.5);
  const auto finding = CheckReadoutLimit(census);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->severity, Severity::kWarning);
  EXPECT_NE(finding->figure.find("1.00 million"), std::string::npos) << finding->figure;
}

TEST(ReadoutLimit, IsNoneWhereEachEventComesByItself) {
  EXPECT_FALSE(CheckReadoutLimit(ReadOut(1e6, 1e6, 1e9)));     // steadily
  EXPECT_FALSE(CheckReadoutLimit(ReadOut(2e5, 1.5e6, 1e9)));   // now more, now fewer
  EXPECT_FALSE(CheckReadoutLimit(ReadOut(2e5, 8e5, kLimit)));  // never so many that they wait
}

TEST(ReadoutLimit, AShortOneIsNoFinding) {
  const ReadoutLimit limit = FindReadoutLimit(ReadOut(2e5, 1.002e6, kLimit).bins());
  EXPECT_LT(limit.seconds, 0.3);
  EXPECT_FALSE(CheckReadoutLimit(ReadOut(1e4, 2e4, 1.2e4)));  // too few for a sensor's limit
}

}  // namespace
}  // namespace evit::diagnosis
