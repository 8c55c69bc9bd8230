#include "tools/run/tracked_time.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace evit::run {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

void Say(double seconds, const char* mode, const char* reason, report::Report* report) {
  report::ModeChange* change = report->add_mode_changes();
  change->set_utime(1e6 * seconds);
  change->set_mode(mode);
  change->set_reason(reason);
}

// Ten poses a second from `from` to `to` (s), both among them.
Trajectory TenHertz(double from, double to) {
  Trajectory poses;
  for (auto t = static_cast<Utime>(1e6 * from); t <= static_cast<Utime>(1e6 * to); t += 100'000)
    poses.push_back({t, SE3()});
  return poses;
}

// Ten seconds: a start of one second that was no success at first, then two losses of one second each, of
// which the second is followed by a vain attempt.
report::Report LostTwice() {
  report::Report report;
  report.set_sequence_s(10);
  report.set_end_utime(10e6);
  Say(0, "BOOTSTRAPPING", "waiting", &report);
  Say(0.2, "LOST", "not found", &report);
  Say(1, "TRACKING", "tracking", &report);
  Say(3.05, "LOST", "biases too large", &report);
  Say(4.05, "TRACKING", "bootstrapped", &report);
  Say(6.05, "LOST", "no events", &report);
  Say(6.5, "BOOTSTRAPPING", "localising", &report);
  Say(6.7, "LOST", "again", &report);
  Say(7.05, "TRACKING", "bootstrapped", &report);
  Say(7.1, "TRACKING", "coasting", &report);
  return report;
}

TEST(TrackedTime, CountsLossesAndTheirTime) {
  report::Report report = LostTwice();
  FillTrackedTime(TenHertz(1, 10), 1, &report);
  EXPECT_EQ(report.times_lost(), 2);
  EXPECT_NEAR(report.lost_share(), 0.2, 1e-9);
  EXPECT_EQ(report.last_loss(), "no events");
}

// Poses of the search itself, or just before and after it, do not bridge a loss that is shorter than the
// time between poses may be.
TEST(TrackedTime, ALossIsNotCoveredHoweverShort) {
  report::Report report = LostTwice();
  FillTrackedTime(TenHertz(1, 10), 1, &report);
  EXPECT_NEAR(report.coverage(), (9 - 2 * 1.1) / 10, 1e-9);
}

TEST(TrackedTime, WithoutLossEverythingIsCovered) {
  report::Report report;
  report.set_sequence_s(10);
  Say(1, "TRACKING", "tracking", &report);
  FillTrackedTime(TenHertz(1, 10), 1, &report);
  EXPECT_EQ(report.times_lost(), 0);
  EXPECT_EQ(report.lost_share(), 0);
  EXPECT_EQ(report.last_loss(), "");
  EXPECT_NEAR(report.coverage(), 0.9, 1e-9);
}

TEST(TrackedTime, BeginningAgainIsNoLossButNotCoveredEither) {
  report::Report report;
  report.set_sequence_s(10);
  report.set_end_utime(10e6);
  Say(0, "TRACKING", "tracking", &report);
  Say(5.05, "BOOTSTRAPPING", "IMU gap of 100 ms", &report);
  Say(5.15, "TRACKING", "bootstrapped", &report);
  FillTrackedTime(TenHertz(0, 10), 1, &report);
  EXPECT_EQ(report.times_lost(), 0);
  EXPECT_NEAR(report.coverage(), 0.98, 1e-9);
}

TEST(TrackedTime, ALossLastsToTheEndWhereNothingEndsIt) {
  report::Report report;
  report.set_sequence_s(10);
  report.set_end_utime(10e6);
  Say(0, "TRACKING", "tracking", &report);
  Say(4, "LOST", "no events", &report);
  FillTrackedTime(TenHertz(0, 3.9), 1, &report);
  EXPECT_NEAR(report.lost_share(), 0.6, 1e-9);
  EXPECT_NEAR(report.coverage(), 0.39, 1e-9);
}

TEST(TrackedTime, ALogThatIsPlayedAgainEndsALoss) {
  report::Report report;
  report.set_sequence_s(10);
  report.set_end_utime(10e6);
  for (int loop = 0; loop < 2; ++loop) {
    Say(0, "TRACKING", "tracking", &report);
    Say(9, "LOST", "no events", &report);
  }
  FillTrackedTime(TenHertz(0, 8), 2, &report);
  EXPECT_EQ(report.times_lost(), 2);
  EXPECT_NEAR(report.lost_share(), 0.05, 1e-9);  // the first until nothing more was heard
}

TEST(TrackedTime, PosesMoreThanHalfASecondApartDoNotCoverTheTimeBetween) {
  const Trajectory poses = {{0, SE3()}, {400'000, SE3()}, {1'400'000, SE3()}, {1'500'000, SE3()}};
  EXPECT_THAT(BreaksOf(poses, {}), ElementsAre(1'400'000));
  EXPECT_DOUBLE_EQ(Coverage(poses, BreaksOf(poses, {}), 2), 0.25);
  EXPECT_THAT(BreaksOf({}, {}), IsEmpty());
}

}  // namespace
}  // namespace evit::run
