#include "common/tracking/gates.h"

#include <gtest/gtest.h>

#include <limits>

namespace evit {
namespace {

TEST(Gates, AMapOnTheEventsIsSeenBetterThanBesideThem) {
  AlignmentQuality quality;
  quality.n_points = kMinPoints;
  quality.mean_value = 100;
  quality.shifted_value = 200;
  EXPECT_TRUE(LiesOnEvents(quality, 0.5, 3, 3));
  EXPECT_FALSE(LiesOnEvents(quality, 0.51, 3, 3));
  EXPECT_FALSE(LiesOnEvents(quality, 0.5, 2.9, 3));
  quality.n_points = kMinPoints - 1;
  EXPECT_FALSE(LiesOnEvents(quality, 0.5, 3, 3));
}

TEST(Gates, APoseFarFromWhereItWasLookedForIsOutOfReach) {
  const StartRange range{0.01, 0.02, 3};
  const SE3 predicted(ExpSO3({0.3, 0.2, -1}), {1, 2, 3});
  const auto reached = [&](double position, double rotation) {
    return WithinReach(predicted.Plus((Vector6d() << position, 0, 0, 0, rotation, 0).finished()), predicted,
                       range);
  };
  EXPECT_TRUE(reached(0.039, 0.079));
  EXPECT_FALSE(reached(0.041, 0));
  EXPECT_FALSE(reached(0, 0.081));
}

TEST(Gates, ImpossibleStatesAreNamed) {
  const FailureOptions limits;
  BodyState state;
  EXPECT_EQ(WhyImplausible(state, limits), "");
  state.velocity.x() = 1.01 * limits.max_speed;
  EXPECT_NE(WhyImplausible(state, limits).find("speed"), std::string::npos);
  state.velocity.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(WhyImplausible(state, limits).find("speed"), std::string::npos);
  state.velocity.setZero();
  state.bias.gyro.z() = 1.01 * limits.max_gyro_bias;
  EXPECT_NE(WhyImplausible(state, limits).find("biases"), std::string::npos);
  state.bias = {};
  state.bias.accel.y() = -1.01 * limits.max_accel_bias;
  EXPECT_NE(WhyImplausible(state, limits).find("biases"), std::string::npos);
}

}  // namespace
}  // namespace evit
