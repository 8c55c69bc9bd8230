#include "tools/simulation/event_sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tools/simulation/noise_source.h"

namespace evit::simulation {
namespace {

using Event = EventSensor::Event;

EventSensorSettings Ideal() {
  EventSensorSettings settings;
  settings.threshold_spread = 0;
  settings.low_pass_ms = 0;
  settings.refractory_ms = 0;
  settings.noise_hz = 0;
  settings.hot_pixels = 0;
  settings.dark = 0;
  return settings;
}

TEST(FastLog, IsTheLogarithm) {
  for (float x = 1e-3F; x < 1e4F; x *= 1.37F) EXPECT_NEAR(FastLog(x), std::log(x), 1e-4) << x;
}

// An edge with a soft profile in log intensity passes along a row of pixels at a constant speed.
struct MovingEdge {
  static constexpr int kWidth = 60;
  static constexpr double kSpeed = 200;     // px/s
  static constexpr double kContrast = 1.5;  // of log intensity; about four thresholds
  static double Log(int x, double t) { return 3 + kContrast / (1 + std::exp(-(kSpeed * t - x) / 0.7)); }
  // When the pixel's log intensity reaches `level` above the dark side.
  static double TimeOf(int x, double level) { return (x - 0.7 * std::log(kContrast / level - 1)) / kSpeed; }
};

std::vector<Event> WatchEdge(const EventSensorSettings& settings, double seconds, bool reversed) {
  EventSensor sensor(MovingEdge::kWidth, 1, settings, 7);
  std::vector<Event> events;
  std::vector<float> image(MovingEdge::kWidth);
  constexpr int kStep = 1000;  // 0.2 px
  for (int t = 0; t <= seconds * 1e6; t += kStep) {
    for (int x = 0; x < MovingEdge::kWidth; ++x) {
      image[x] = static_cast<float>(std::exp((reversed ? -1 : 1) * MovingEdge::Log(x, t * 1e-6) + 3));
    }
    if (t == 0) {
      sensor.Start(0, 1, image.data());
    } else {
      sensor.Step(0, 1, image.data(), t - kStep, t, &events);
    }
  }
  return events;
}

TEST(EventSensor, TimesEventsOfAMovingEdge) {
  const std::vector<Event> events = WatchEdge(Ideal(), 0.35, false);
  for (int x = 8; x < 50; ++x) {
    std::vector<double> times;
    for (const Event& event : events) {
      if (event.x != x) continue;
      EXPECT_EQ(event.p, 1);
      times.push_back(event.t * 1e-6);
    }
    ASSERT_GE(times.size(), 3U) << x;
    ASSERT_LE(times.size(), 5U) << x;
    // The first level is by chance; the following lie one threshold apart.
    const double first = MovingEdge::kContrast / (1 + std::exp(-(MovingEdge::kSpeed * times[0] - x) / 0.7));
    EXPECT_LT(first, 0.68);
    for (std::size_t k = 1; k < times.size(); ++k) {
      EXPECT_NEAR(times[k], MovingEdge::TimeOf(x, first + 0.33 * static_cast<double>(k)), 6e-4) << x;
    }
  }
}

TEST(EventSensor, DarkeningIsNegative) {
  const std::vector<Event> events = WatchEdge(Ideal(), 0.35, true);
  ASSERT_GT(events.size(), 100U);
  for (const Event& event : events) EXPECT_EQ(event.p, 0);
}

TEST(EventSensor, LowPassDelaysByItsTimeConstant) {
  EventSensorSettings settings = Ideal();
  const std::vector<Event> sharp = WatchEdge(settings, 0.35, false);
  settings.low_pass_ms = 3;
  const std::vector<Event> slow = WatchEdge(settings, 0.35, false);
  const auto mean = [](const std::vector<Event>& events) {
    double sum = 0, n = 0;
    for (const Event& event : events) {
      if (event.x >= 8 && event.x < 45) sum += event.t, n += 1;
    }
    return sum / n;
  };
  EXPECT_NEAR(mean(slow) - mean(sharp), 3000, 700);
}

TEST(EventSensor, KeepsTheRefractoryTime) {
  EventSensorSettings settings = Ideal();
  settings.refractory_ms = 2.5;
  const std::vector<Event> events = WatchEdge(settings, 0.35, false);
  std::vector<int> last(MovingEdge::kWidth, -1'000'000);
  for (const Event& event : events) {
    EXPECT_GE(event.t - last[event.x], 2500);
    last[event.x] = event.t;
  }
  EXPECT_LT(events.size(), WatchEdge(Ideal(), 0.35, false).size());
}

TEST(EventSensor, ConstantLightIsSilent) {
  EventSensor sensor(32, 32, Ideal(), 1);
  const std::vector<float> image(std::size_t{32} * 32, 77.0F);
  std::vector<Event> events;
  sensor.Start(0, 32, image.data());
  for (int t = 0; t < 100'000; t += 5000) sensor.Step(0, 32, image.data(), t, t + 5000, &events);
  EXPECT_TRUE(events.empty());
}

TEST(NoiseSource, HasItsRateAndHotPixels) {
  EventSensorSettings settings;
  settings.noise_hz = 2;
  settings.hot_pixels = 3;
  NoiseSource noise(100, 80, settings, 5);
  std::vector<Event> events;
  for (int t = 7000; t <= 10'000'000; t += 7000) noise.Until(t, &events);
  std::vector<int> counts(std::size_t{100} * 80, 0);
  for (const Event& event : events) ++counts[event.y * 100 + event.x];
  EXPECT_EQ(std::count_if(counts.begin(), counts.end(), [](int n) { return n > 1500; }), 3);
  const double background = std::count_if(events.begin(), events.end(),
                                          [&](const Event& e) { return counts[e.y * 100 + e.x] <= 1500; });
  EXPECT_NEAR(background, 2.0 * 10 * 8000, 3000);
}

TEST(SortByTime, KeepsTheOrderOfEqualStamps) {
  std::vector<Event> events{{30, 1, 0, 1}, {11, 2, 0, 1}, {30, 3, 0, 1}, {20, 4, 0, 1}, {11, 5, 0, 1}};
  SortByTime(10, 30, &events);
  std::vector<int> order;
  order.reserve(events.size());
  for (const Event& event : events) order.push_back(event.x);
  EXPECT_EQ(order, (std::vector<int>{2, 5, 4, 1, 3}));
}

TEST(EventSensor, DarkPixelsAreSlowWhereLightCounts) {
  EventSensorSettings settings = Ideal();
  settings.low_pass_ms = 1;
  settings.bright_grey = 1e5;  // all of this edge is far darker
  const std::vector<Event> slow = WatchEdge(settings, 0.35, false);
  settings.bright_grey = 0;
  const std::vector<Event> even = WatchEdge(settings, 0.35, false);
  ASSERT_FALSE(slow.empty());
  EXPECT_GT(slow.front().t, even.front().t);
  settings.bright_grey = 1e-3;  // all of it is brighter: nothing is slower
  EXPECT_EQ(WatchEdge(settings, 0.35, false).size(), even.size());
}

TEST(EventSensor, LeaksMakeBrighterEventsWithoutChange) {
  EventSensorSettings settings = Ideal();
  settings.leak_hz = 5;
  EventSensor sensor(50, 1, settings, 2);
  const std::vector<float> image(50, 100.0F);
  sensor.Start(0, 1, image.data());
  std::vector<Event> events;
  for (int t = 0; t < 4'000'000; t += 2'000) sensor.Step(0, 1, image.data(), t, t + 2'000, &events);
  EXPECT_NEAR(static_cast<double>(events.size()), 50 * 5 * 4, 60);
  for (const Event& event : events) EXPECT_EQ(event.p, 1);
}

TEST(EventSensor, DriftMovesAllThresholdsTogether) {
  EventSensorSettings settings = Ideal();
  const std::size_t even = WatchEdge(settings, 0.35, false).size();
  settings.threshold_drift = 0.2;
  EXPECT_NE(WatchEdge(settings, 0.35, false).size(), even);
}

}  // namespace
}  // namespace evit::simulation
