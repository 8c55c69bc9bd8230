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

TEST(SearchSchedule, AComparisonCostsASearchButTriesNoVertical) {
  SearchSchedule schedule(1), other(1);
  const RecentImu imu;
  const Eigen::Vector3d first = schedule.Begin(5 * kS, kUp, imu);
  EXPECT_EQ(first, other.Begin(5 * kS, kUp, imu));
  schedule.BeginComparison(5 * kS);
  EXPECT_EQ(schedule.Begin(5 * kS, kUp, imu), other.Begin(5 * kS, kUp, imu));
  for (int left = 2; left > 0; --left) {
    EXPECT_TRUE(schedule.Due(5 * kS, false));
    schedule.BeginComparison(5 * kS);
  }
  EXPECT_FALSE(schedule.Due(5 * kS, false));
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
