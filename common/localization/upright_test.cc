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
  EXPECT_LT(EstimateUpright(still.Samples(1'000'000, 2'000'000, {}), 9.81).sigma, 0.02);
  EXPECT_GT(EstimateUpright(wild.Samples(1'000'000, 2'000'000, {}), 9.81).sigma, 0.03);
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
