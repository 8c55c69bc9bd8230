#include "common/imu/imu_plausibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "common/geometry/degrees.h"
#include "common/geometry/so3.h"

namespace evit {
namespace {

using ::testing::HasSubstr;

// A hand-held body that rolls and pitches by some 30 degrees, at 200 Hz; what a good IMU reads.
std::vector<ImuSample> Handheld(double seconds, double speed = 1) {
  std::vector<ImuSample> samples;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (int k = 0; k < 200 * seconds; ++k) {
    const double t = 0.005 * k;
    const Eigen::Vector3d gyro(speed * std::cos(2 * t), 0.8 * speed * std::cos(1.7 * t + 1), 0.3 * speed);
    q = q * ExpSO3(0.005 * gyro);
    const Eigen::Vector3d moved(std::sin(9 * t), std::cos(7 * t), 0.5 * std::sin(11 * t));
    samples.push_back(
        {Utime{5000} * k, gyro, q.conjugate() * Eigen::Vector3d(moved + Eigen::Vector3d(0, 0, 9.81))});
  }
  return samples;
}

std::string Changed(std::vector<ImuSample> samples, const std::function<void(ImuSample*)>& change) {
  for (ImuSample& s : samples) change(&s);
  return ImuComplaint(samples);
}

TEST(ImuPlausibility, GoodImusAreFine) {
  EXPECT_EQ(ImuComplaint(Handheld(10)), "");
  EXPECT_EQ(ImuComplaint(Handheld(0.4)), "");
  EXPECT_EQ(ImuComplaint(Handheld(10, 4)), "");     // fast
  EXPECT_EQ(ImuComplaint(Handheld(10, 0.01)), "");  // still
  EXPECT_EQ(ImuComplaint({}), "");
  EXPECT_EQ(ImuComplaint(Handheld(0.05)), "");
}

TEST(ImuPlausibility, UnitsAreTold) {
  for (const double speed : {0.1, 0.5, 1.0, 3.0}) {
    EXPECT_THAT(Changed(Handheld(10, speed), [](ImuSample* s) { s->gyro *= kDegreesPerRadian; }),
                HasSubstr("deg/s"))
        << speed;
  }
  const auto samples = Handheld(5);
  EXPECT_THAT(Changed(samples, [](ImuSample* s) { s->accel /= 9.81; }), HasSubstr("in g:"));
  EXPECT_THAT(Changed(samples, [](ImuSample* s) { s->accel *= 1000 / 9.81; }), HasSubstr("in mg"));
  EXPECT_THAT(Changed(samples, [](ImuSample* s) { s->accel *= 1000; }), HasSubstr("not in m/s^2"));
  EXPECT_THAT(Changed(Handheld(0.4), [](ImuSample* s) { s->accel /= 9.81; }), HasSubstr("in g:"));
}

TEST(ImuPlausibility, TakenOffGravityAndSwappedColumnsAreTold) {
  const auto samples = Handheld(5);
  EXPECT_THAT(Changed(samples,
                      [](ImuSample* s) {
                        s->accel = Eigen::Vector3d(std::sin(1e-5 * s->t), 0.4, std::cos(2e-5 * s->t));
                      }),
              HasSubstr("taken off"));
  EXPECT_THAT(Changed(samples, [](ImuSample* s) { std::swap(s->accel, s->gyro); }), HasSubstr("swapped"));
}

// What is left without gravity can have a mean of any length, 1 as well.
TEST(ImuPlausibility, TakenOffGravityIsNotTakenForAUnit) {
  std::vector<ImuSample> samples = Handheld(10);
  for (std::size_t k = 0; k < samples.size(); ++k)
    samples[k].accel = Eigen::Vector3d(k / 100 % 2 == 0 ? 0.95 : (k / 100 % 4 == 1 ? 0.3 : 2.5), 0, 0);
  EXPECT_THAT(ImuComplaint(samples), HasSubstr("gravity seems to have been taken off"));
}

TEST(ImuPlausibility, DirectionOfGravityAtTheStart) {
  std::vector<ImuSample> samples = Handheld(0.3, 0.1);
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  EXPECT_EQ(GravityComplaint(samples, level), "");
  EXPECT_EQ(GravityComplaint({}, level), "");
  EXPECT_THAT(GravityComplaint(samples, Eigen::Quaterniond(Eigen::AngleAxisd(1.6, Eigen::Vector3d::UnitX()))),
              HasSubstr("start pose"));
  for (ImuSample& s : samples) s.accel *= -1;
  EXPECT_THAT(GravityComplaint(samples, level), HasSubstr("sign turned"));
}

}  // namespace
}  // namespace evit
