#include "services/window_optimizer/load_limiter.h"

#include <gtest/gtest.h>

#include "common/bus/memory_bus.h"

namespace evit {
namespace {

using std::chrono::milliseconds;

class LoadLimiterTest : public ::testing::Test {
 protected:
  // A keyframe every 50 ms.
  LoadLimiter::Limits BeginAfter(milliseconds waited, bool shows_load = true, bool others_wait = false) {
    arrived_ += milliseconds(50);
    return limiter_.Begin({{}, arrived_}, shows_load, others_wait, arrived_ + waited);
  }

  std::unique_ptr<Bus> bus_ = OpenMemoryBus(MakeMemoryHub());
  StatusReporter status_{bus_.get(), Channels(), "window_optimizer", 1};
  LoadLimiter limiter_{&status_};
  LoadLimiter::Clock::time_point arrived_ = LoadLimiter::Clock::now();
};

TEST_F(LoadLimiterTest, ASolveMayTakeAShareOfTheTimeSinceTheKeyframeBefore) {
  BeginAfter(milliseconds(0));
  EXPECT_NEAR(BeginAfter(milliseconds(0)).solve_budget, 0.03, 1e-9);
  EXPECT_NEAR(BeginAfter(milliseconds(0), true, true).solve_budget, 0.015, 1e-9);
}

TEST_F(LoadLimiterTest, KeyframesThatWaitTakePointsAndAreCounted) {
  double share = 1;
  for (int k = 0; k < 5; ++k) share = BeginAfter(milliseconds(100)).point_share;
  EXPECT_EQ(share, 0.5);
  EXPECT_EQ(status_.Counter("overload.level"), 1);
  EXPECT_EQ(status_.Counter("overload.steps"), 1);
  for (int k = 0; k < 100; ++k) share = BeginAfter(milliseconds(0)).point_share;
  EXPECT_EQ(share, 1);
  EXPECT_EQ(status_.Counter("overload.level"), 0);
  EXPECT_EQ(status_.Counter("overload.steps"), 1);
}

TEST_F(LoadLimiterTest, KeyframesThatAreLateForAnotherReasonShowNoLoad) {
  for (int k = 0; k < 50; ++k) EXPECT_EQ(BeginAfter(milliseconds(1000), false).point_share, 1);
  EXPECT_EQ(limiter_.keyframe_stride(), 1);
}

}  // namespace
}  // namespace evit
