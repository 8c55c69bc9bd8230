#include "tools/simulation/profile.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tools/simulation/builtin_motion.h"
#include "tools/simulation/load_motion.h"

namespace evit::simulation {
namespace {

TEST(Profile, NamesAreKnownAndIdealChangesNothing) {
  Profile profile = Profile::kReal;
  EXPECT_FALSE(ProfileFromName("perfect", &profile));
  ASSERT_TRUE(ProfileFromName("ideal", &profile));
  SimulationSettings settings;
  ApplyProfile(profile, &settings);
  EXPECT_EQ(settings.sensor.bright_grey, 0);
  EXPECT_EQ(settings.optics.blur_px, 0);
  EXPECT_FALSE(settings.map.images.on);
  EXPECT_EQ(settings.imu.vibration_accel, 0);
}

TEST(Profile, RealIsSensorAndCameraMap) {
  SimulationSettings sensor, map, real;
  ApplyProfile(Profile::kSensor, &sensor);
  ApplyProfile(Profile::kCameraMap, &map);
  ApplyProfile(Profile::kReal, &real);
  EXPECT_GT(sensor.optics.blur_px, 0);
  EXPECT_FALSE(sensor.map.images.on);
  EXPECT_TRUE(map.map.images.on);
  EXPECT_EQ(map.optics.blur_px, 0);
  EXPECT_EQ(real.optics.blur_px, sensor.optics.blur_px);
  EXPECT_EQ(real.sensor.threshold_spread, sensor.sensor.threshold_spread);
  EXPECT_TRUE(real.map.images.on);
}

TEST(Optics, BlurSpreadsLightAndSaturationCutsIt) {
  std::vector<float> image(31 * 21, 100.0F);
  image[10 * 31 + 15] = 200;
  std::vector<float> blurred = image;
  ApplyOptics({0.8, 0}, 31, 21, &blurred);
  EXPECT_NEAR(std::accumulate(blurred.begin(), blurred.end(), 0.0),
              std::accumulate(image.begin(), image.end(), 0.0), 0.1);
  EXPECT_LT(blurred[10 * 31 + 15], 130);
  EXPECT_GT(blurred[10 * 31 + 16], 105);
  ApplyOptics({0, 150}, 31, 21, &image);
  EXPECT_EQ(image[10 * 31 + 15], 150);
  EXPECT_EQ(image[0], 100);
}

TEST(Vibration, HasTheStrengthAskedForAndNoMean) {
  MotionSettings motion_settings;
  motion_settings.source = "builtin:handheld";
  motion_settings.duration_s = 4;
  Rig rig;
  rig.imu_rate_hz = 200;
  rig.camera.width = 64;
  rig.camera.height = 48;
  rig.camera.fx = rig.camera.fy = 50;
  const Motion motion = LoadMotion(motion_settings, rig);
  ImuSettings still, shaken;
  shaken.vibration_accel = 0.2;
  shaken.vibration_gyro = 0.01;
  const SimulatedImu a = SimulateImu(motion.spline, rig, still, motion.begin, motion.end, 5),
                     b = SimulateImu(motion.spline, rig, shaken, motion.begin, motion.end, 5);
  ASSERT_EQ(a.samples.size(), b.samples.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), square = mean, gyro = mean;
  const double n = static_cast<double>(a.samples.size());
  for (std::size_t k = 0; k < a.samples.size(); ++k) {
    const Eigen::Vector3d d = b.samples[k].accel - a.samples[k].accel;
    mean += d / n;
    square += d.cwiseAbs2() / n;
    gyro += (b.samples[k].gyro - a.samples[k].gyro).cwiseAbs2() / n;
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(std::sqrt(square[axis]), 0.2, 0.03);
    EXPECT_NEAR(std::sqrt(gyro[axis]), 0.01, 0.0015);
    EXPECT_LT(std::abs(mean[axis]), 0.01);
  }
}

}  // namespace
}  // namespace evit::simulation
