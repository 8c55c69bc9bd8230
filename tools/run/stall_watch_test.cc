#include "tools/run/stall_watch.h"

#include <gtest/gtest.h>

namespace evit::run {
namespace {

// `seconds` in which the services compute and wait for a processor for these shares of one.
void Pass(double seconds, double computing, double waiting, StallWatch* watch, double* now,
          ServiceTime* used) {
  for (double s = 0; s < seconds; s += 1) {
    *now += 1;
    used->computing += computing;
    used->waiting += waiting;
    watch->Tick(*now, *used);
  }
}

class StallWatchTest : public ::testing::Test {
 protected:
  void Let(double seconds, double computing, double waiting) {
    Pass(seconds, computing, waiting, &watch_, &now_, &used_);
  }
  StallWatch watch_;
  double now_ = 1000;
  ServiceTime used_{5, 3};
};

TEST_F(StallWatchTest, ServicesWithNothingToDoAreStuckAfterAMinute) {
  Let(60, 0.03, 0.01);
  EXPECT_FALSE(watch_.stuck());
  Let(5, 0.03, 0.01);
  EXPECT_TRUE(watch_.stuck());
  watch_.Progress();
  EXPECT_FALSE(watch_.stuck());
}

TEST_F(StallWatchTest, ServicesThatComputeOrAreStarvedAreNot) {
  Let(500, 1, 0);
  EXPECT_FALSE(watch_.stuck());
  watch_.Progress();
  Let(5000, 0.05, 0.95);  // twenty others want the processor
  EXPECT_FALSE(watch_.stuck());
  EXPECT_EQ(watch_.idle(), 0);
}

TEST_F(StallWatchTest, ComputingThatLeadsToNothingEnds) {
  Let(620, 1, 0);
  EXPECT_TRUE(watch_.stuck());
}

TEST_F(StallWatchTest, TimeInWhichNobodyRanDoesNotCount) {
  Let(5, 0.03, 0);
  now_ += 3600;  // the host slept
  Let(5, 0.03, 0);
  EXPECT_LT(watch_.idle(), 15);
}

TEST_F(StallWatchTest, ARestartedServiceBeginsAtZero) {
  Let(5, 1, 0);
  used_ = {};
  Let(5, 1, 0);
  EXPECT_LT(watch_.idle(), 2);
}

}  // namespace
}  // namespace evit::run
