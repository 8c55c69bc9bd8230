#include "services/window_optimizer/imu_history.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

ImuSample At(Utime t) {
  return {t, Eigen::Vector3d::Constant(1e-6 * t), Eigen::Vector3d::Constant(2e-6 * t)};
}

TEST(ImuHistory, BetweenInterpolatesBothEnds) {
  ImuHistory history;
  for (Utime t = 0; t <= 50'000; t += 5'000) ASSERT_TRUE(history.Add(At(t)));
  const auto samples = history.Between(7'500, 21'000);
  ASSERT_EQ(samples.size(), 5U);  // 7.5, 10, 15, 20, 21 ms
  EXPECT_EQ(samples.front().t, 7'500);
  EXPECT_EQ(samples.back().t, 21'000);
  EXPECT_NEAR(samples.front().gyro.x(), 0.0075, 1e-9);
  EXPECT_NEAR(samples.back().accel.x(), 0.042, 1e-9);
  EXPECT_EQ(ImuHistory::LongestGap(samples), 5'000);
}

TEST(ImuHistory, EndsOnSamplesAreTakenAsTheyAre) {
  ImuHistory history;
  for (Utime t = 0; t <= 20'000; t += 5'000) history.Add(At(t));
  const auto samples = history.Between(5'000, 15'000);
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_EQ(samples[1].t, 10'000);
}

TEST(ImuHistory, SaysWhatItDoesNotCover) {
  ImuHistory history;
  EXPECT_TRUE(history.Between(0, 1).empty());
  for (Utime t = 10'000; t <= 20'000; t += 5'000) history.Add(At(t));
  EXPECT_TRUE(history.Between(5'000, 15'000).empty());
  EXPECT_TRUE(history.Between(15'000, 25'000).empty());
  EXPECT_TRUE(history.Between(15'000, 15'000).empty());
}

TEST(ImuHistory, AClockThatJumpsClearsIt) {
  ImuHistory history;
  for (Utime t = 10'000'000; t <= 10'100'000; t += 5'000) history.Add(At(t));
  EXPECT_FALSE(history.Add(At(9'500'000)));
  EXPECT_TRUE(history.Add(At(5'000'000)));  // back by five seconds
  EXPECT_TRUE(history.Add(At(5'005'000)));
  EXPECT_EQ(history.Between(5'000'000, 5'005'000).size(), 2U);
  EXPECT_TRUE(history.Between(10'000'000, 10'005'000).empty());
  EXPECT_TRUE(history.Add(At(3'600'000'000)));  // an hour ahead
  EXPECT_TRUE(history.Between(5'005'000, 3'600'000'000).empty());
}

TEST(ImuHistory, LeavesOutWhatIsNotNewer) {
  ImuHistory history;
  EXPECT_TRUE(history.Add(At(10)));
  EXPECT_FALSE(history.Add(At(10)));
  EXPECT_FALSE(history.Add(At(5)));
}

}  // namespace
}  // namespace evit
