#include "services/window_optimizer/imu_rate_pose.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

constexpr double kGravity = 9.81;  // m/s^2
constexpr Utime kStart = 1'000'000;

// At rest but for its bias, samples of 5 ms.
class ImuRatePoseTest : public ::testing::Test {
 protected:
  ImuRatePoseTest() {
    state_.T_map_body.p = {1, 2, 3};
    state_.velocity = {0.5, 0, 0};
    state_.bias.accel = {0, 0.1, 0};
    for (Utime t = kStart - 50'000; t <= kStart + 100'000; t += 5'000)
      history_.Add({t, Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 0.1, kGravity)});
  }
  BodyState state_;
  ImuHistory history_;
  ImuRatePose pose_{kGravity};
};

TEST_F(ImuRatePoseTest, FollowsTheSamplesFromTheKeyframesState) {
  pose_.StartFrom(kStart + 2'000, state_);
  const auto at = pose_.At(kStart + 100'000, history_);
  ASSERT_TRUE(at.has_value());
  EXPECT_LT((at->T_map_body.p - Eigen::Vector3d(1.049, 2, 3)).norm(), 1e-9);
  EXPECT_LT((at->velocity - state_.velocity).norm(), 1e-9);
}

TEST_F(ImuRatePoseTest, NoneWithoutAState) {
  EXPECT_FALSE(pose_.At(kStart, history_).has_value());
  pose_.StartFrom(kStart, state_);
  EXPECT_TRUE(pose_.At(kStart + 5'000, history_).has_value());
  pose_.Stop();
  EXPECT_FALSE(pose_.At(kStart + 5'000, history_).has_value());
}

TEST_F(ImuRatePoseTest, NoneWhereTheHistoryDoesNotReachBack) {
  pose_.StartFrom(kStart - 60'000, state_);
  EXPECT_FALSE(pose_.At(kStart, history_).has_value());
}

}  // namespace
}  // namespace evit
