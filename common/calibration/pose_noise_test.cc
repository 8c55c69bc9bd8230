#include "common/calibration/pose_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace evit {
namespace {

// White noise of 1 on all axes, and on top what wanders with a period of 400 poses.
PoseNoise Measured(double wander) {
  std::mt19937 rng(4);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Matrix<double, 6, 1>> residuals;
  for (int k = 0; k < 3200; ++k) {
    Eigen::Matrix<double, 6, 1> r;
    for (int i = 0; i < 6; ++i) r[i] = normal(rng) + wander * std::sin(6.2832 * k / 400 + i);
    residuals.push_back(r);
  }
  return MeasurePoseNoise(residuals);
}

TEST(PoseNoise, WhiteNoiseIsAlikeForOnePose) {
  const PoseNoise noise = Measured(0);
  EXPECT_NEAR(noise.position, 1, 0.06);
  EXPECT_NEAR(noise.rotation, 1, 0.06);
  EXPECT_LT(noise.position_correlation, 1.6);
  EXPECT_LT(noise.rotation_correlation, 1.6);
}

TEST(PoseNoise, ErrorsThatWanderBelowWhiteOnesCount) {
  // 0.2 rms: 4 % of the power, where the autocorrelation counts as gone; of means over 128 poses it is nearly
  // all.
  const PoseNoise noise = Measured(0.28);
  EXPECT_GT(noise.position_correlation, 3);
  EXPECT_GT(noise.rotation_correlation, 3);
}

}  // namespace
}  // namespace evit
