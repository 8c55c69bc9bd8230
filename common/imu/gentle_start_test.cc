#include "common/imu/gentle_start.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

const Eigen::Vector3d kAtRest(0.5, -1.2, 9.7);

// s until it is seen at this acceleration (m/s^2) that grows by `drift` a second; 100 where it is not.
double SeenAfter(double acceleration, double drift) {
  GentleStart start;
  start.Begin(kAtRest);
  for (int k = 1; k <= 1000; ++k) {
    const double t = 0.1 * k;
    if (start.Seen(kAtRest + Eigen::Vector3d(0, acceleration + drift * t, 0), 0.1)) return t;
  }
  return 100;
}

TEST(GentleStart, IsSeenBeforeTheBodyIsFast) {
  for (const double acceleration : {0.05, 0.09, 0.3}) {
    const double seconds = SeenAfter(acceleration, 0);
    EXPECT_LT(acceleration * seconds, 0.2) << acceleration;
    EXPECT_GE(acceleration * seconds, 0.1) << acceleration;
  }
}

TEST(GentleStart, DriftOfTheAccelerometerIsNone) { EXPECT_EQ(SeenAfter(0, 0.02 / 60), 100); }

TEST(GentleStart, NoiseOfTheReadingAtTheBeginIsNone) { EXPECT_EQ(SeenAfter(0.01, 0), 100); }

}  // namespace
}  // namespace evit
