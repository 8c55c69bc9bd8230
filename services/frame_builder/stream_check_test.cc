#include "services/frame_builder/stream_check.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

std::string After(double gravity, Utime imu_clock) {
  StreamCheck check(/*needs_imu=*/true);
  for (int k = 0; k < 1000; ++k) {
    check.AddImu({imu_clock + Utime{5000} * k, {0, 0, 0}, {0, 0, gravity}});
    check.AddEvents(Utime{5000} * k);
  }
  return check.Complaint();
}

TEST(StreamCheck, AStreamThatStandsStillIsNoOtherClock) {
  StreamCheck check(/*needs_imu=*/true);
  for (int k = 0; k < 4000; ++k) {
    if (k < 1000 || k > 3000) check.AddImu({Utime{5000} * k, {0, 0, 0}, {0, 0, 9.81}});
    if (k < 500 || k > 2500) check.AddEvents(Utime{5000} * k);
    EXPECT_EQ(check.Complaint(), "") << k;
  }
}

TEST(StreamCheck, TellsUnitsAndTwoClocks) {
  EXPECT_EQ(After(9.81, 0), "");
  EXPECT_EQ(After(9.81, -300'000), "");  // late, one clock
  EXPECT_NE(After(1, 0).find("in g"), std::string::npos);
  EXPECT_NE(After(9.81, 1'642'661'138'000'000).find("two clocks"), std::string::npos);
}

TEST(StreamCheck, TellsThatNoImuComesWhereOneIsNeeded) {
  StreamCheck with(/*needs_imu=*/true), without(/*needs_imu=*/false);
  for (Utime t = 0; t <= 5'000'000; t += 5'000) {
    with.AddEvents(t), without.AddEvents(t);
    if (t < 2'000'000) {
      EXPECT_EQ(with.Complaint(), "");
    }
  }
  EXPECT_NE(with.Complaint().find("evt.textproto"), std::string::npos);
  EXPECT_EQ(without.Complaint(), "");
  with.AddImu({5'000'000, {0, 0, 0}, {0, 0, 9.81}});
  EXPECT_EQ(with.Complaint(), "");
  with.Clear();
  for (Utime t = 0; t <= 5'000'000; t += 5'000) with.AddEvents(t);
  EXPECT_NE(with.Complaint(), "");
}

}  // namespace
}  // namespace evit
