#include "common/diagnosis/clock_drift.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "tests/helpers/line_world.h"

namespace evit::diagnosis {
namespace {

constexpr int kDriftLines = 24;
constexpr Utime kMiddle = 3'000'000;  // us, of the instants

// What the check says where the body that the events see at a stamp is `offset` us further on than the truth
// says, and `rate` us more for each us after the middle.
std::optional<Finding> DriftFound(double rate, Utime offset, double best = 0, int excerpts = 6,
                                  Utime camera_time_offset = 7'000) {
  const MapIndex map(test::Lines(kDriftLines));
  World given = test::LineWorld(), real = given;
  real.truth = test::Waving([&](Utime t) {
    return t + offset + static_cast<Utime>(rate * static_cast<double>(t - kMiddle - 7'000));
  });
  // A camera whose stamps lie far off the IMU's: poses so much later are the same.
  const Utime later = camera_time_offset - given.rig.camera_time_offset;
  for (World* world : {&given, &real}) {
    world->rig.camera_time_offset += later;
    for (StampedPose& s : world->truth) s.t += later;
  }
  return CheckClockDrift(map, given, test::EventsOf(map.map(), real, test::Instants(excerpts)), best);
}

// Per cent, positive where it is said to be slow.
double PercentTold(const Finding& finding) {
  double percent = 0;
  char way[5] = "";
  EXPECT_EQ(std::sscanf(finding.what.c_str(), "The camera's clock runs %lf %% too %4s", &percent, way), 2)
      << finding.what;
  return std::string(way) == "slow" ? percent : -percent;
}

TEST(ClockDrift, AnOffsetThatGrowsEvenlyIsOne) {
  const std::optional<Finding> slow = DriftFound(0.04, 0);
  ASSERT_TRUE(slow);
  EXPECT_EQ(slow->check, "clock-drift");
  EXPECT_EQ(slow->severity, Severity::kError);
  EXPECT_NEAR(PercentTold(*slow), 4, 0.4);
  EXPECT_NE(slow->what.find("after 6.0 s"), std::string::npos) << slow->what;
}

TEST(ClockDrift, IsFoundWithAnOffsetAndWhereverTheCamerasStampsBegin) {
  const std::optional<Finding> fast = DriftFound(-0.028, 50'000, 0, 6, 20'000'000);
  ASSERT_TRUE(fast);
  EXPECT_NEAR(PercentTold(*fast), -2.8, 0.4);
}

TEST(ClockDrift, AnOffsetAloneIsNone) { EXPECT_FALSE(DriftFound(0, 60'000)); }

TEST(ClockDrift, IsNotToldWhereSomethingElseExplainsTheEventsAsWell) {
  EXPECT_FALSE(DriftFound(0.04, 0, 0.95));
}

TEST(ClockDrift, IsNotToldOfFewViewsOrOfEventsOfAnotherPlace) {
  EXPECT_FALSE(DriftFound(0.04, 0, 0, 4));
  const MapIndex map(test::Lines(kDriftLines));
  World elsewhere = test::LineWorld();
  elsewhere.rig.T_body_camera.q = elsewhere.rig.T_body_camera.q * ExpSO3({0, 0, 1.5});
  EXPECT_FALSE(
      CheckClockDrift(map, test::LineWorld(), test::EventsOf(map.map(), elsewhere, test::Instants(6)), 0));
}

}  // namespace
}  // namespace evit::diagnosis
