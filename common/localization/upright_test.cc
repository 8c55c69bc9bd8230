#include "common/localization/upright.h"

#include <gtest/gtest.h>

#include "common/geometry/degrees.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

double ErrorDegrees(const synthetic::Motion& motion, double at, double seconds) {
  const auto end = static_cast<Utime>(at * 1e6), begin = end - static_cast<Utime>(seconds * 1e6);
  const Upright upright = EstimateUpright(motion.Samples(begin, end, {}), motion.gravity);
  EXPECT_TRUE(upright.known);
  const Eigen::Vector3d up = motion.Rotation(at).conjugate() * Eigen::Vector3d::UnitZ();
  return std::acos(std::min(1.0, up.dot(upright.up))) * kDegreesPerRadian;
}

TEST(Upright, AtRestItIsTheForce) {
  synthetic::Motion motion;
  motion.amplitude = motion.turn = 0;
  EXPECT_LT(ErrorDegrees(motion, 2, 0.5), 0.01);
}

TEST(Upright, TurningAloneDoesNotDisturbIt) {
  synthetic::Motion motion;
  motion.amplitude = 0;
  motion.turn = 1;
  for (const double t : {2.0, 2.7, 3.9}) EXPECT_LT(ErrorDegrees(motion, t, 1), 0.3);
}

TEST(Upright, LongerIsSurerWhereTheBodyGoesToAndFro) {
  synthetic::Motion motion;
  motion.amplitude = 0.4;
  double brief = 0, longer = 0;
  for (double t = 4; t < 8; t += 0.25)
    brief += ErrorDegrees(motion, t, 1), longer += ErrorDegrees(motion, t, 3);
  EXPECT_LT(longer, 0.6 * brief);
  EXPECT_LT(longer / 16, 5);
}

TEST(Upright, SaysHowUnsureItIs) {
  synthetic::Motion still, wild;
  still.amplitude = 0;
  wild.amplitude = 1.5;
  EXPECT_LT(EstimateUpright(still.Samples(1'000'000, 2'000'000, {}), 9.81).sigma, 0.025);
  EXPECT_GT(EstimateUpright(wild.Samples(1'000'000, 2'000'000, {}), 9.81).sigma, 0.03);
}

// A fast motion to and fro whose half period is about as long as the window: a mean of the forces, however
// weighted, is off by 15 to 30 degrees.
TEST(Upright, OfHalfASecondOfAFastMotionHalfTheErrorOfAMean) {
  double error = 0, mean_error = 0;
  int n = 0;
  for (double start = 0; start < 1; start += 0.1, ++n) {
    std::vector<ImuSample> samples;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (int k = 0; k <= 100; ++k) {
      const double t = start + 0.005 * k;
      ImuSample sample;
      sample.t = static_cast<Utime>(1e6 * t);
      sample.accel = {6 * std::sin(6.5 * t), 3 * std::cos(5 * t), 9.81 + std::sin(8 * t)};
      mean += sample.accel;
      samples.push_back(sample);
    }
    const Upright upright = EstimateUpright(samples, 9.81);
    ASSERT_TRUE(upright.known);
    error += std::acos(upright.up.z());
    mean_error += std::acos(mean.normalized().z());
    EXPECT_LT(std::acos(upright.up.z()), 3.5 * upright.sigma);  // it knows
  }
  EXPECT_LT(error, 0.6 * mean_error);
  EXPECT_GT(mean_error / n * kDegreesPerRadian, 10);
}

TEST(Upright, WhatIsNoGravityIsNotKnown) {
  synthetic::Motion motion;
  std::vector<ImuSample> samples = motion.Samples(0, 1'000'000, {});
  EXPECT_FALSE(EstimateUpright({samples.begin(), samples.begin() + 5}, 9.81).known);
  for (ImuSample& s : samples) s.accel *= 0.1;  // in g
  EXPECT_FALSE(EstimateUpright(samples, 9.81).known);
  EXPECT_FALSE(EstimateUpright({}, 9.81).known);
}

}  // namespace
}  // namespace evit
