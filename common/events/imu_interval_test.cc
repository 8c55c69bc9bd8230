#include "common/events/imu_interval.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

ImuSample At(Utime t) { return {t, {1e-3 * static_cast<double>(t), 0, 0}, {0, 0, 9.81}}; }

class ImuIntervalTest : public ::testing::Test {
 protected:
  ImuIntervalTest() {
    interval_.Begin(At(1'000));
    interval_.Add(At(6'000));
  }
  ImuInterval interval_;
};

TEST_F(ImuIntervalTest, ClosesAtASample) {
  const ImuInterval::Closed closed = interval_.CloseAt(12'000, At(12'000));
  ASSERT_EQ(closed.samples.size(), 3u);
  EXPECT_EQ(closed.samples.front().t, 1'000);
  EXPECT_EQ(closed.samples.back().t, 12'000);
  EXPECT_EQ(closed.gap, 6'000);
  EXPECT_EQ(interval_.begin(), 12'000);
  EXPECT_EQ(interval_.newest().t, 12'000);
  EXPECT_EQ(interval_.size(), 1u);
}

TEST_F(ImuIntervalTest, InterpolatesBothEndsOfIntervalsBetweenTwoSamples) {
  const ImuInterval::Closed first = interval_.CloseAt(7'000, At(11'000));
  EXPECT_DOUBLE_EQ(first.samples.back().gyro.x(), 7);
  const ImuInterval::Closed second = interval_.CloseAt(9'000, At(11'000));
  ASSERT_EQ(second.samples.size(), 2u);
  EXPECT_DOUBLE_EQ(second.samples.front().gyro.x(), 7);
  EXPECT_DOUBLE_EQ(second.samples.back().gyro.x(), 9);
  EXPECT_EQ(second.gap, 5'000);  // of the raw samples around it
  EXPECT_EQ(interval_.newest().t, 6'000);
}

TEST_F(ImuIntervalTest, IsNotBegunOnceCleared) {
  interval_.Clear();
  EXPECT_FALSE(interval_.begun());
}

}  // namespace
}  // namespace evit
