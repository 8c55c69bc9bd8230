#include "common/diagnosis/accel_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/geometry/so3.h"

namespace evit::diagnosis {
namespace {

constexpr double kGravity = 9.81;

struct Motion {
  std::vector<ImuSample> imu;
  Trajectory truth;
};

// Swings by `swing` m at 0.7 Hz and turns to and fro; `scale` is the accelerometer's.
Motion Swinging(double seconds, double swing, double scale, unsigned seed) {
  Motion motion;
  std::mt19937 rng(seed);
  std::normal_distribution<double> noise(0, 0.05);
  const double w = 2 * M_PI * 0.7, phase = 0.1 * seed;
  for (Utime t = 0; t <= std::llround(1e6 * seconds); t += 5'000) {
    const double s = ToSeconds(t), angle = 0.4 * std::sin(3 * s);
    const Eigen::Quaterniond q = ExpSO3({angle, 0, 0});
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d acceleration = -swing * w * w * std::sin(w * s + phase) * up;
    const Eigen::Vector3d force = q.conjugate() * (acceleration + kGravity * up);
    motion.imu.push_back({t,
                          {1.2 * std::cos(3 * s), 0, 0},
                          scale * force + Eigen::Vector3d(noise(rng), noise(rng), noise(rng))});
    if (t % 10'000 == 0) motion.truth.push_back({t, {q, swing * std::sin(w * s + phase) * up}});
  }
  return motion;
}

Severity Of(const Motion& motion, bool with_truth) {
  return CheckAccelScale(motion.imu, with_truth ? motion.truth : Trajectory{}, kGravity).severity;
}

TEST(AccelScale, ATenthIsFoundAndARightOneIsNot) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    for (const double swing : {0.0, 0.05, 0.3}) {
      for (const bool with_truth : {false, true}) {
        EXPECT_EQ(Of(Swinging(2.5, swing, 1, seed), with_truth), Severity::kGood) << seed << ", " << swing;
        EXPECT_EQ(Of(Swinging(20, swing, 1, seed), with_truth), Severity::kGood) << seed << ", " << swing;
      }
      for (const double scale : {0.88, 1.12}) {
        EXPECT_EQ(Of(Swinging(2.5, swing, scale, seed), true), Severity::kWarning) << seed << ", " << swing;
        EXPECT_EQ(Of(Swinging(20, swing, scale, seed), false), Severity::kWarning) << seed << ", " << swing;
      }
    }
  }
}

// In a short and lively recording the speed gained may explain what is too much: it says so.
TEST(AccelScale, TheUncertaintyGrowsWithTheMotion) {
  const MeanForce still = MeasureMeanForce(Swinging(2.5, 0, 1, 1).imu, {}),
                  lively = MeasureMeanForce(Swinging(2.5, 0.3, 1, 1).imu, {});
  EXPECT_LT(still.sigma, 0.03);
  EXPECT_GT(lively.sigma, 0.3);
  EXPECT_NEAR(lively.up, kGravity, 3 * lively.sigma);
}

}  // namespace
}  // namespace evit::diagnosis
