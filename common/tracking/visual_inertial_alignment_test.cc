#include "common/tracking/visual_inertial_alignment.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/helpers/tracking_bench.h"

namespace evit {
namespace {

using synthetic::Motion;

TEST(VisualInertialAlignment, FindsVelocitiesAndBiasesFromNoisyPoses) {
  const Motion motion;
  const ImuBias truth{{0.01, -0.008, 0.012}, {0.1, 0.05, -0.08}};
  const ImuNoise noise{7e-4, 1.3e-3, 7e-6, 6e-5};
  std::mt19937 rng(4);
  std::normal_distribution<double> n;
  for (const double pose_noise : {0.0, 1.0}) {
    std::vector<BootstrapFrame> frames;
    for (int k = 0; k <= 60; ++k) {
      const Utime t = 1'000'000 + k * 10'000;
      SE3 pose = motion.State(ToSeconds(t)).T_map_body;
      Eigen::Matrix<double, 6, 1> d;
      for (int c = 0; c < 6; ++c) d[c] = pose_noise * 0.002 * n(rng);
      pose = pose.Plus(d);
      std::shared_ptr<Preintegration> imu;
      if (k > 0)
        imu = std::make_shared<Preintegration>(motion.Samples(t - 10'000, t, truth), ImuBias{}, noise);
      frames.push_back({t, pose, imu});
    }
    const auto result = AlignVisualInertial(frames, 9.81, TestOptions().bootstrap, 2.0);
    ASSERT_TRUE(result.success) << result.reason;
    const BodyState expected = motion.State(1.6), &got = result.states.back();
    EXPECT_LT((got.velocity - expected.velocity).norm(), pose_noise > 0 ? 0.03 : 0.01);
    EXPECT_LT((got.bias.gyro - truth.gyro).norm(), pose_noise > 0 ? 0.01 : 0.002);
    EXPECT_LT((got.bias.accel - truth.accel).norm(), 0.06);
  }
}

TEST(VisualInertialAlignment, RefusesAMapWhoseZAxisIsNotUp) {
  const Motion motion;
  const SE3 tilt(ExpSO3({0.3, 0, 0}), {0, 0, 0});
  std::vector<BootstrapFrame> frames;
  for (int k = 0; k <= 40; ++k) {
    const Utime t = 1'000'000 + k * 10'000;
    std::shared_ptr<Preintegration> imu;
    if (k > 0) {
      imu = std::make_shared<Preintegration>(motion.Samples(t - 10'000, t, {}), ImuBias{},
                                             ImuNoise{7e-4, 1.3e-3, 7e-6, 6e-5});
    }
    frames.push_back({t, tilt * motion.State(ToSeconds(t)).T_map_body, imu});
  }
  const auto result = AlignVisualInertial(frames, 9.81, TestOptions().bootstrap, 2.0);
  EXPECT_FALSE(result.success);
  EXPECT_NE(result.reason.find("z axis"), std::string::npos);
}

}  // namespace
}  // namespace evit
