#include "common/diagnosis/stamp_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

namespace evit::diagnosis {
namespace {

constexpr double kStampedSeconds = 3;
constexpr int kStampedRate = 200;

std::vector<ImuSample> SteadyImu(double factor) {
  std::vector<ImuSample> imu;
  for (int k = 0; k <= kStampedSeconds * kStampedRate; ++k)
    imu.push_back({std::llround(factor * 1e6 * k / kStampedRate), {0, 0, 0.1}, {0, 0, 9.81}});
  return imu;
}

EventCensus StampedEvents(const std::function<Utime(Utime)>& stamp) {
  EventCensus census(64, 64);
  EventArray events;
  for (Utime t = 0; t < 1e6 * kStampedSeconds; t += 20)
    events.push_back(stamp(t), static_cast<std::uint16_t>(t / 20 % 64),
                     static_cast<std::uint16_t>(t / 60 % 64), t / 20 % 2);
  census.Add(events);
  return census;
}

std::string WrongStamps(const std::function<Utime(Utime)>& stamp, double imu_factor) {
  Rig rig;
  rig.imu_rate_hz = kStampedRate;
  const EventCensus events = StampedEvents(stamp);
  const std::vector<ImuSample> imu = SteadyImu(imu_factor);
  std::string text;
  for (const Finding& f :
       CheckStamps(events, events.seconds(), imu, ToSeconds(imu.back().t - imu.front().t), rig))
    if (f.severity != Severity::kGood) text += f.check + ": " + f.what + "\n";
  return text;
}

TEST(StampChecks, MicrosecondsAreGood) {
  EXPECT_EQ(WrongStamps([](Utime t) { return t; }, 1), "");
  EXPECT_EQ(WrongStamps([](Utime t) { return t / 500 * 500; }, 1), "") << "fine enough";
}

TEST(StampChecks, OtherUnitsAreNamed) {
  EXPECT_NE(WrongStamps([](Utime t) { return 1000 * t; }, 1).find("events are in nanoseconds"),
            std::string::npos);
  EXPECT_NE(WrongStamps([](Utime t) { return t / 1000; }, 1).find("events are in milliseconds"),
            std::string::npos);
  EXPECT_NE(WrongStamps([](Utime t) { return t; }, 1000).find("the IMU are in nanoseconds"),
            std::string::npos);
  const std::string both = WrongStamps([](Utime t) { return 1000 * t; }, 1000);
  EXPECT_NE(both.find("events are in nanoseconds"), std::string::npos) << both;
  EXPECT_NE(both.find("the IMU are in nanoseconds"), std::string::npos) << both;
}

TEST(StampChecks, RoundedStampsAreFound) {
  EXPECT_NE(WrongStamps([](Utime t) { return t / 10'000 * 10'000; }, 1).find("every 10.0 ms"),
            std::string::npos);
}

}  // namespace
}  // namespace evit::diagnosis
