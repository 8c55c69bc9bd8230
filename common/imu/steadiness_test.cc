#include "common/imu/steadiness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "tests/helpers/handheld_motion.h"

namespace evit {
namespace {

const ImuNoise kDensities{7e-4, 1.3e-3, 7e-6, 5.6e-5};
const Eigen::Vector3d kRestingRate(0.02, -0.01, 0.03), kRestingForce(0.5, -1.2, 9.7);
using Course = std::function<ImuSample(double seconds)>;

// Readings of a course at 200 Hz, with noise.
std::vector<ImuSample> Read(const Course& course, Utime begin, Utime end, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  const double rate = std::sqrt(200);
  std::vector<ImuSample> samples;
  for (Utime t = begin; t <= end; t += 5'000) {
    ImuSample sample = course(ToSeconds(t));
    sample.t = t;
    for (int axis = 0; axis < 3; ++axis) {
      sample.gyro[axis] += kDensities.gyro_density * rate * noise(random);
      sample.accel[axis] += kDensities.accel_density * rate * noise(random);
    }
    samples.push_back(sample);
  }
  return samples;
}

ImuSample Resting(double /*seconds*/) { return ImuSample{0, kRestingRate, kRestingForce}; }

TEST(Steadiness, TellsTheReadingsAtRest) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    Steadiness steadiness(kDensities);
    steadiness.Add(Read(Resting, 0, 300'000, seed));
    const auto reading = steadiness.SteadyReading(300'000);
    ASSERT_TRUE(reading) << seed;
    EXPECT_LT((reading->gyro - kRestingRate).norm(), 0.006);
    EXPECT_LT((reading->accel - kRestingForce).norm(), 0.012);
    EXPECT_EQ(reading->t, 300'000);
  }
}

TEST(Steadiness, VibrationIsNoMotion) {
  Steadiness steadiness(kDensities);
  steadiness.Add(Read(
      [](double t) {
        ImuSample sample = Resting(t);
        const double shaken = std::sin(2 * M_PI * 60 * t);
        sample.gyro.x() += 0.03 * shaken;
        sample.accel.z() += 0.5 * shaken;
        return sample;
      },
      0, 300'000));
  EXPECT_TRUE(steadiness.SteadyReading(300'000));
}

TEST(Steadiness, AHandMoves) {
  for (Utime begin = 0; begin < 3'000'000; begin += 100'000) {
    Steadiness steadiness(kDensities);
    steadiness.Add(test::HandheldImu(begin, begin + 300'000, 5'000));
    EXPECT_FALSE(steadiness.SteadyReading(begin + 300'000)) << begin;
  }
}

TEST(Steadiness, NeedsAQuarterOfASecondOrAllSinceTheInstantAsked) {
  Steadiness steadiness(kDensities);
  EXPECT_FALSE(steadiness.SteadyReading(0));
  // A brake of 1 m/s^2 until 100 ms.
  const Course stop = [](double t) {
    ImuSample sample = Resting(t);
    if (t < 0.1) sample.accel.x() -= 1;
    return sample;
  };
  steadiness.Add(Read(stop, 0, 340'000));
  EXPECT_FALSE(steadiness.SteadyReading(340'000));
  steadiness.Add(Read(stop, 340'000, 360'000));  // the first of them is there already
  EXPECT_TRUE(steadiness.SteadyReading(360'000));
  EXPECT_FALSE(steadiness.SteadyReading(50'000));
  EXPECT_FALSE(steadiness.SteadyReading(-1));  // nothing is known from then
  steadiness.Add(Read(stop, 365'000, 1'500'000));
  EXPECT_FALSE(steadiness.SteadyReading(400'000));  // forgotten
  EXPECT_TRUE(steadiness.SteadyReading(600'000));
}

TEST(Steadiness, AHoleMayHideMotion) {
  Steadiness steadiness(kDensities);
  steadiness.Add(Read(Resting, 0, 100'000));
  steadiness.Add(Read(Resting, 290'000, 350'000));
  EXPECT_FALSE(steadiness.SteadyReading(350'000));
}

// Noise that a rig file exaggerates must not hide motion.
TEST(Steadiness, LargeDensitiesDoNotHideMotion) {
  Steadiness steadiness({1, 10, 0, 0});
  steadiness.Add(test::HandheldImu(0, 300'000, 5'000));
  EXPECT_FALSE(steadiness.SteadyReading(300'000));
}

}  // namespace
}  // namespace evit
