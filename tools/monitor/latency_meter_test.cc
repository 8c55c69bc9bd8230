#include "tools/monitor/latency_meter.h"

#include <gtest/gtest.h>

namespace evit::monitor {
namespace {

constexpr Utime kSensor = 5'000'000'000;        // the sensor's clock
constexpr std::int64_t kHost = 90'000'000'000;  // the host's, for the same instant

// IMU messages of `seconds` at `pace`, each `delay(i)` us under way.
template <typename Delay>
void Feed(LatencyMeter* meter, double seconds, double pace, Delay delay) {
  for (int i = 0; i < static_cast<int>(seconds * 200); ++i) {
    const std::int64_t t = 5'000 * i;
    meter->AddData(kSensor + static_cast<std::int64_t>(static_cast<double>(t) * pace), kHost + t + delay(i));
  }
}

TEST(LatencyMeter, IsTheTimeBehindTheQuickestMessage) {
  LatencyMeter meter;
  Feed(&meter, 4, 1, [](int i) { return i % 10 == 0 ? 200 : 3'000; });
  EXPECT_NEAR(meter.MsSince(kSensor + 4'000'000, kHost + 4'030'200), 30, 1e-9);
  EXPECT_EQ(meter.MsSince(kSensor + 4'000'000, kHost + 4'000'000), 0);
}

TEST(LatencyMeter, KnowsNothingAtFirst) {
  LatencyMeter meter;
  EXPECT_LT(meter.MsSince(kSensor, kHost), 0);
  Feed(&meter, 0.5, 1, [](int) { return 100; });
  EXPECT_LT(meter.MsSince(kSensor, kHost), 0);
}

TEST(LatencyMeter, SaysNothingWhereDataDoNotComeInRealTime) {
  for (const double pace : {0.5, 2.0, 20.0}) {
    LatencyMeter meter;
    Feed(&meter, 4, pace, [](int) { return 100; });
    EXPECT_LT(meter.MsSince(kSensor + static_cast<Utime>(4e6 * pace), kHost + 4'030'000), 0) << pace;
  }
}

TEST(LatencyMeter, SaysNothingAfterAJumpOfTheRecordingAndThenAgain) {
  LatencyMeter meter;
  Feed(&meter, 3, 1, [](int) { return 100; });
  for (int i = 0; i < 900; ++i)
    meter.AddData(kSensor - 60'000'000 + 5'000 * i, kHost + 3'000'000 + 5'000 * i);
  EXPECT_NEAR(meter.MsSince(kSensor - 60'000'000 + 4'500'000, kHost + 3'000'000 + 4'520'000), 20, 1e-9);
}

TEST(LatencyMeter, KnowsNothingOnceNoDataCome) {
  LatencyMeter meter;
  Feed(&meter, 4, 1, [](int) { return 100; });
  EXPECT_GE(meter.MsSince(kSensor + 4'000'000, kHost + 4'500'000), 0);
  EXPECT_LT(meter.MsSince(kSensor + 4'000'000, kHost + 9'000'000), 0);
}

}  // namespace
}  // namespace evit::monitor
