#include "common/tracking/rival_watch.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

class RivalWatchTest : public ::testing::Test {
 protected:
  RivalWatchTest() { watch_.Start(0); }
  // A rival 10 cm ahead of a body that moves by 1 cm a keyframe.
  std::optional<SE3> Show(double by, double ahead = 0.1, double own = 8) {
    t_ += 20'000, x_ += 0.01;
    StartRival rival;
    rival.distinct = true;
    rival.significance = -by;
    rival.T_map_body.p = {x_ + ahead, 0, 0};
    SE3 pose;
    pose.p = {x_, 0, 0};
    return watch_.Confirm(t_, pose, rival, own);
  }

  RivalWatch watch_;
  Utime t_ = 0;
  double x_ = 0;
};

TEST_F(RivalWatchTest, ARivalThatWinsThreeTimesInOnePlaceIsTheRightPose) {
  EXPECT_FALSE(Show(6));
  EXPECT_FALSE(Show(6, 0.11));
  const std::optional<SE3> right = Show(6);
  ASSERT_TRUE(right);
  EXPECT_DOUBLE_EQ(right->p.x(), x_ + 0.1);
}

TEST_F(RivalWatchTest, ChanceIsNot) {
  for (int k = 0; k < 9; ++k) EXPECT_FALSE(Show(6, k % 2 == 0 ? 0.1 : 0.3));  // here and there
  for (int k = 0; k < 9; ++k) EXPECT_FALSE(Show(k % 3 == 0 ? 1 : 6));         // now and then
  for (int k = 0; k < 9; ++k) EXPECT_FALSE(Show(6, 0.1, 4));                  // both explain nothing
}

TEST_F(RivalWatchTest, SearchesOftenAtFirstAndWhileInDoubt) {
  EXPECT_FALSE(watch_.Due(199'000, false));
  EXPECT_TRUE(watch_.Due(200'000, false));
  EXPECT_TRUE(watch_.Due(50'000, true));
  t_ = 1'500'000;
  Show(0);
  EXPECT_FALSE(watch_.Due(t_ + 1'999'000, false));
  EXPECT_TRUE(watch_.Due(t_ + 2'000'000, false));
  Show(6);
  EXPECT_TRUE(watch_.Due(t_ + 1, false));
}

}  // namespace
}  // namespace evit
