#include "tools/simulation/readout.h"

#include <gtest/gtest.h>

namespace evit::simulation {
namespace {

using Event = EventSensor::Event;

// An event a millisecond, in steps of ten.
std::vector<Event> Through(const ReadoutSettings& settings, int n, int gap_us) {
  Readout readout(settings, 3);
  std::vector<Event> all;
  for (int k = 0; k < n; k += 10) {
    std::vector<Event> step;
    for (int i = 1; i <= 10; ++i) step.push_back({(k + i) * gap_us, static_cast<std::uint16_t>(i), 0, 1});
    readout.Pass((k + 10) * gap_us, &step);
    all.insert(all.end(), step.begin(), step.end());
  }
  return all;
}

bool Sorted(const std::vector<Event>& events) {
  for (std::size_t k = 1; k < events.size(); ++k) {
    if (events[k].t < events[k - 1].t) return false;
  }
  return true;
}

TEST(Readout, WithoutBurstsAndLimitNothingChanges) {
  const std::vector<Event> events = Through({}, 100, 50);
  ASSERT_EQ(events.size(), 100U);
  EXPECT_EQ(events[37].t, 38 * 50);
}

TEST(Readout, BurstsRepeatAPixelAndStayInOrder) {
  ReadoutSettings settings;
  settings.burst_share = 0.5;
  const std::vector<Event> events = Through(settings, 5000, 50);
  // Half, a quarter, ...: one more for each event; some are still to come.
  EXPECT_NEAR(static_cast<double>(events.size()), 10'000, 400);
  EXPECT_TRUE(Sorted(events));
}

TEST(Readout, MoreEventsThanItReadsComeLateAndThenAreLost) {
  ReadoutSettings settings;
  settings.rate_hz = 10'000;
  settings.patience_ms = 5;
  const std::vector<Event> events = Through(settings, 2000, 50);  // twice as many as it can
  EXPECT_TRUE(Sorted(events));
  EXPECT_NEAR(static_cast<double>(events.size()), 1000 + 5 * 10, 5);
  EXPECT_GE(events[100].t - 101 * 50, 4000);
}

}  // namespace
}  // namespace evit::simulation
