#include "services/window_optimizer/load_governor.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

TEST(LoadGovernor, NothingHappensWhileNothingWaits) {
  LoadGovernor governor;
  for (int k = 0; k < 1000; ++k)
    governor.Observe(k % 50 == 0 ? 40 : 1);  // a late one now and then is not overload
  EXPECT_EQ(governor.level(), 0);
  EXPECT_EQ(governor.point_share(), 1);
  EXPECT_EQ(governor.keyframe_stride(), 1);
}

TEST(LoadGovernor, PointsGoFirstThenKeyframes) {
  LoadGovernor governor;
  double share = 1, stride = 1;
  bool points_left = true;
  for (int k = 0; k < 100; ++k) {
    governor.Observe(100);
    EXPECT_LE(governor.point_share(), share);
    EXPECT_GE(governor.keyframe_stride(), stride);
    if (governor.keyframe_stride() > 1) points_left = governor.point_share() > 0.25;
    share = governor.point_share(), stride = governor.keyframe_stride();
  }
  EXPECT_FALSE(points_left);
  EXPECT_EQ(governor.level(), LoadGovernor::kMaxLevel);
  EXPECT_EQ(share, 0.25);
  EXPECT_EQ(stride, 4);
}

TEST(LoadGovernor, RecoversStepByStep) {
  LoadGovernor governor;
  for (int k = 0; k < 100; ++k) governor.Observe(100);
  for (int k = 0; k < 99; ++k) governor.Observe(0);
  EXPECT_EQ(governor.level(), 4);
  governor.Observe(0);
  EXPECT_EQ(governor.level(), 3);
  for (int k = 0; k < 300; ++k) governor.Observe(0);
  EXPECT_EQ(governor.level(), 0);
}

TEST(LoadGovernor, ASolveMayTakeAShareOfTheTimeBetweenKeyframesWithinLimits) {
  EXPECT_DOUBLE_EQ(LoadGovernor::SolveBudget(0.05, false), 0.03);
  EXPECT_DOUBLE_EQ(LoadGovernor::SolveBudget(0.001, false), 0.015);
  EXPECT_DOUBLE_EQ(LoadGovernor::SolveBudget(1e6, false), 0.1);
}

TEST(LoadGovernor, ASolveTakesTheLeastWhileOthersWait) {
  EXPECT_DOUBLE_EQ(LoadGovernor::SolveBudget(0.05, true), 0.015);
}

}  // namespace
}  // namespace evit
