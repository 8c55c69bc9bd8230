#include "common/localization/search_schedule.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

constexpr Utime kS = 1'000'000;
const Upright kUp{true, Eigen::Vector3d::UnitZ(), 0.1};

TEST(SearchSchedule, AFewAtOnceThenTenASecond) {
  SearchSchedule schedule(1);
  const RecentImu imu;
  int at_once = 0, later = 0;
  for (; schedule.Due(5 * kS, false); ++at_once) schedule.Begin(5 * kS, kUp, imu);
  EXPECT_EQ(at_once, 5);
  for (Utime t = 5 * kS; t < 7 * kS; t += kS / 100)
    for (; schedule.Due(t, false); ++later) schedule.Begin(t, kUp, imu);
  EXPECT_NEAR(later, 20, 1);
}

TEST(SearchSchedule, RarelyWhileSomethingConvinces) {
  SearchSchedule schedule(1);
  EXPECT_TRUE(schedule.Due(5 * kS, true));
  schedule.Begin(5 * kS, kUp, RecentImu());
  EXPECT_TRUE(schedule.Due(5 * kS, false));
  EXPECT_FALSE(schedule.Due(5 * kS + kS / 2, true));
  EXPECT_TRUE(schedule.Due(6 * kS, true));
  schedule.Clear();
  EXPECT_TRUE(schedule.Due(5 * kS, true));
}

}  // namespace
}  // namespace evit
