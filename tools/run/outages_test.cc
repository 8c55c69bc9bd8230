#include "tools/run/outages.h"

#include <gtest/gtest.h>

#include "common/bus/memory_bus.h"

namespace evit::run {
namespace {

using std::chrono::milliseconds;

TEST(OutagesTest, MeasureTheTimeWithoutPoses) {
  const auto bus = OpenMemoryBus(MakeMemoryHub());
  Outages outages(bus.get(), Channels());
  const Outages::Clock::time_point t0 = Outages::Clock::now();
  for (const int ms : {0, 30, 60, 90, 250, 280, 310}) outages.Add(t0 + milliseconds(ms));
  const auto never = t0 + std::chrono::hours(1);
  // Dead at 70: one keyframe still came through, then 160 ms of nothing.
  EXPECT_DOUBLE_EQ(outages.MsAfter(t0 + milliseconds(70), t0 + milliseconds(310)), 180);
  EXPECT_DOUBLE_EQ(outages.MsAfter(t0 + milliseconds(-20), never), 50);  // what comes later is not its fault
  // Nothing was missing: the usual distance.
  EXPECT_DOUBLE_EQ(outages.MsAfter(t0 + milliseconds(255), t0 + milliseconds(300)), 25);
  // No pose came any more.
  EXPECT_DOUBLE_EQ(outages.MsAfter(t0 + milliseconds(300), never), 2000);
  EXPECT_DOUBLE_EQ(outages.MsAfter(t0 + milliseconds(320), t0 + milliseconds(400)), 80);
}

TEST(OutagesTest, CountKeyframesWithoutAnswer) {
  const auto bus = OpenMemoryBus(MakeMemoryHub());
  Outages outages(bus.get(), Channels());
  const Outages::Clock::time_point t0 = Outages::Clock::now();
  int ms = 0;
  // 3 lost before the death; 6 and 7 after it; another epoch starts where it likes.
  for (const int seq : {1, 2, 4, 5, 5, 8, 9}) outages.AddAnswer(t0 + milliseconds(ms += 10), 1, seq);
  outages.AddAnswer(t0 + milliseconds(ms += 10), 2, 0);
  EXPECT_EQ(outages.KeyframesLostAfter(t0 + milliseconds(35), t0 + std::chrono::hours(1)), 2);
  EXPECT_EQ(outages.KeyframesLostAfter(t0, t0 + milliseconds(35)), 1);
}

TEST(OutagesTest, LastUntilTheEndWithoutPoses) {
  const auto bus = OpenMemoryBus(MakeMemoryHub());
  const Outages outages(bus.get(), Channels());
  const auto now = Outages::Clock::now();
  EXPECT_DOUBLE_EQ(outages.MsAfter(now, now + milliseconds(500)), 500);
}

}  // namespace
}  // namespace evit::run
