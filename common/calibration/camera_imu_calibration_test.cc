// Recordings of rigs that are known, calibrated from rig files that are wrong.
#include "common/calibration/camera_imu_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/geometry/degrees.h"
#include "tests/helpers/calibration_recording.h"

namespace evit {
namespace {

using test::Recording;
using ::testing::HasSubstr;

void Print(const Recording& recording, const CameraImuCalibration& c) {
  const SE3 &truth = recording.rig.T_body_camera, &found = c.values.T_body_camera;
  std::printf(
      "off by %.3f deg, %.2f mm, %.0f us, tilt %.3f (%.3f) deg, accel %.1f (%.1f) mm/s^2; noise %.2f mm x "
      "%.0f, "
      "%.3f deg x %.0f; %d poses, %d left out\n",
      AngularDistance(truth.q, found.q) / kRadiansPerDegree, 1e3 * (truth.p - found.p).norm(),
      static_cast<double>(c.values.offset - recording.rig.camera_time_offset),
      (c.values.tilt - recording.tilt).norm() / kRadiansPerDegree,
      std::sqrt(c.covariance.block<2, 2>(7, 7).trace()) / kRadiansPerDegree,
      1e3 * (c.values.bias.accel - recording.bias.accel).norm(),
      1e3 * std::sqrt(c.covariance.block<3, 3>(12, 12).trace()), 1e3 * c.noise.position,
      c.noise.position_correlation, c.noise.rotation / kRadiansPerDegree, c.noise.rotation_correlation,
      c.n_poses, c.n_rejected);
}

void ExpectFound(const Recording& recording, const CameraImuCalibration& c, double offset_us = 500) {
  ASSERT_TRUE(c.success) << c.reason;
  Print(recording, c);
  EXPECT_TRUE(c.unobservable.empty());
  for (const RigDirection& d : c.rig.directions) EXPECT_TRUE(d.observable);
  EXPECT_LT(AngularDistance(recording.rig.T_body_camera.q, c.values.T_body_camera.q),
            0.1 * kRadiansPerDegree);
  EXPECT_LT((recording.rig.T_body_camera.p - c.values.T_body_camera.p).norm(), 5e-3);
  EXPECT_NEAR(static_cast<double>(c.values.offset), static_cast<double>(recording.rig.camera_time_offset),
              offset_us);
  EXPECT_LT((c.values.bias.gyro - recording.bias.gyro).norm(), 0.002);
  EXPECT_LT((c.values.bias.accel - recording.bias.accel).norm(), 0.03);
  EXPECT_LT((c.values.tilt - recording.tilt).norm(), 0.2 * kRadiansPerDegree);
}

// All 15 errors, in the order of the covariance.
Eigen::Matrix<double, 15, 1> Errors(const Recording& recording, const CameraImuCalibration& c) {
  Eigen::Matrix<double, 15, 1> e;
  e << recording.rig.T_body_camera.p - c.values.T_body_camera.p,
      LogSO3(c.values.T_body_camera.q.conjugate() * recording.rig.T_body_camera.q),
      ToSeconds(recording.rig.camera_time_offset - c.values.offset), recording.tilt - c.values.tilt,
      recording.bias.gyro - c.values.bias.gyro, recording.bias.accel - c.values.bias.accel;
  return e;
}

// Every value is wrong by no more than its sigmas say, also where the rig file's wrong figure was kept.
void ExpectWithinSigmas(const Recording& recording, const CameraImuCalibration& c) {
  const Eigen::Matrix<double, 15, 1> e = Errors(recording, c);
  for (int k = 0; k < 15; ++k) EXPECT_LT(std::abs(e[k]), 3 * std::sqrt(c.covariance(k, k))) << "value " << k;
}

TEST(CameraImuCalibration, FindsTheRigFromAMotionThatLeans) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    Recording recording;
    recording.seed = seed;
    const CameraImuCalibration c = CalibrateCameraImu(recording.Camera(), recording.Imu(), recording.Wrong());
    ExpectFound(recording, c);
    EXPECT_NEAR(c.noise.position, 2e-3, 1e-3);
    EXPECT_GT(c.noise.position_correlation, 10);  // what wanders does so for a second
  }
}

TEST(CameraImuCalibration, FindsTheRigFromFarOff) {
  Recording recording;
  Rig wrong = recording.Wrong(4);  // 7 deg and 10 cm
  wrong.camera_time_offset = recording.rig.camera_time_offset - 50'000;
  // A rig file that is ten sigmas off draws the offset by a hundredth towards it.
  ExpectFound(recording, CalibrateCameraImu(recording.Camera(), recording.Imu(), wrong), 1000);
}

// A motion that leans little: each value is wrong by what its sigma says, and what trades off (1 mrad of tilt
// for 10 mm/s^2 of bias) is named.
TEST(CameraImuCalibration, SigmasAreOfTheErrorsSizeWhereTiltAndBiasTradeOff) {
  constexpr int kSeeds = 10;
  Eigen::Matrix<double, 15, 1> squares = Eigen::Matrix<double, 15, 1>::Zero();
  double all = 0;
  int named = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Recording recording;
    recording.motion = test::Lively;
    recording.seed = static_cast<unsigned>(seed);
    recording.seconds = 5;
    recording.imu_noise = 2;  // as noisy as the batch takes it to be
    const CameraImuCalibration c = CalibrateCameraImu(recording.Camera(), recording.Imu(), recording.Wrong());
    ASSERT_TRUE(c.success) << c.reason;
    const Eigen::Matrix<double, 15, 1> e = Errors(recording, c);
    const Eigen::Matrix<double, 15, 1> normal =
        e.cwiseQuotient(Eigen::Matrix<double, 15, 1>(c.covariance.diagonal().cwiseSqrt()));
    for (const int k : {7, 8, 12, 13, 14}) EXPECT_LT(std::abs(normal[k]), 3) << "seed " << seed << ", " << k;
    squares += normal.cwiseAbs2();
    all += e.dot(c.covariance.ldlt().solve(e)) / 15;
    for (const Unobservable& u : c.unobservable) named += u.value == Unobservable::Value::kTilt ? 1 : 0;
  }
  const Eigen::Matrix<double, 15, 1> rms = (squares / kSeeds).cwiseSqrt();
  std::printf("normalised: extrinsic %.2f %.2f %.2f, %.2f %.2f %.2f; offset %.2f; tilt %.2f %.2f; ", rms[0],
              rms[1], rms[2], rms[3], rms[4], rms[5], rms[6], rms[7], rms[8]);
  std::printf("gyro %.2f %.2f %.2f; accel %.2f %.2f %.2f; NEES / 15 %.2f; tilt named %d times\n", rms[9],
              rms[10], rms[11], rms[12], rms[13], rms[14], all / kSeeds, named);
  for (int k = 0; k < 15; ++k) {
    // The sigma of the offset allows for poses that lag behind the motion, which these do not.
    EXPECT_GT(rms[k], k == 6 ? 0 : 0.3) << k;
    EXPECT_LT(rms[k], 2) << k;
  }
  EXPECT_GT(all / kSeeds, 0.3);
  EXPECT_LT(all / kSeeds, 2);
  EXPECT_GE(named, kSeeds / 2);
}

TEST(CameraImuCalibration, FindsTheTiltOfTheMap) {
  Recording recording;
  recording.seed = 3;
  recording.tilt = {3 * kRadiansPerDegree, -2 * kRadiansPerDegree};
  ExpectFound(recording, CalibrateCameraImu(recording.Camera(), recording.Imu(), recording.Wrong()));
}

TEST(CameraImuCalibration, LeavesOutPosesThatAreFarOff) {
  Recording recording;
  recording.outliers = 0.05;
  const CameraImuCalibration c = CalibrateCameraImu(recording.Camera(), recording.Imu(), recording.Wrong());
  ExpectFound(recording, c);
  EXPECT_GT(c.n_rejected, 0.03 * c.n_poses);
  EXPECT_LT(c.n_rejected, 0.08 * c.n_poses);
}

TEST(CameraImuCalibration, BridgesHolesInTheTracking) {
  Recording recording;
  Trajectory camera = recording.Camera();
  camera.erase(camera.begin() + 300, camera.begin() + 400);  // a second
  ExpectFound(recording, CalibrateCameraImu(camera, recording.Imu(), recording.Wrong()));
}

TEST(CameraImuCalibration, OneAxisOfTurningKeepsWhatItDoesNotShow) {
  Recording recording;
  recording.motion = test::YawOnly;
  const Rig wrong = recording.Wrong();
  const CameraImuCalibration c = CalibrateCameraImu(recording.Camera(), recording.Imu(), wrong);
  ASSERT_TRUE(c.success) << c.reason;
  Print(recording, c);
  // How far the camera is along the axis of turning makes no difference to what it sees.
  const RigDirection& worst = c.rig.directions.front();
  EXPECT_FALSE(worst.observable);
  EXPECT_GT(worst.posterior_variance, 0.9);
  EXPECT_GT(std::abs(worst.one_sigma.head<3>().normalized().z()), 0.99);
  EXPECT_NEAR(c.values.T_body_camera.p.z(), wrong.T_body_camera.p.z(), 1e-3);
  EXPECT_NEAR(c.values.T_body_camera.p.x(), recording.rig.T_body_camera.p.x(), 12e-3);
  EXPECT_NEAR(c.values.T_body_camera.p.y(), recording.rig.T_body_camera.p.y(), 12e-3);
  EXPECT_NEAR(static_cast<double>(c.values.offset), 3'000, 500);
  ExpectWithinSigmas(recording, c);
}

TEST(CameraImuCalibration, TooSlowAMotionKeepsTheRigFile) {
  Recording recording;
  recording.motion = test::Creeping;
  recording.seconds = 5;
  const Rig wrong = recording.Wrong();
  const CameraImuCalibration c = CalibrateCameraImu(recording.Camera(), recording.Imu(), wrong);
  ASSERT_TRUE(c.success) << c.reason;
  Print(recording, c);
  EXPECT_EQ(c.values.offset, wrong.camera_time_offset);
  ExpectWithinSigmas(recording, c);
  EXPECT_LT((c.values.T_body_camera.p - wrong.T_body_camera.p).norm(), 1e-3);
}

TEST(CameraImuCalibration, NothingMovesWhereARecordingSaysLessThanTheRigFile) {
  Recording recording;
  recording.motion = test::Creeping;
  recording.seconds = 5;
  Rig stated = recording.Wrong(0.1);
  stated.T_body_camera_sigma = {Eigen::Vector3d::Constant(0.002), Eigen::Vector3d::Constant(0.002)};
  const CameraImuCalibration c = CalibrateCameraImu(recording.Camera(), recording.Imu(), stated);
  ASSERT_TRUE(c.success) << c.reason;
  EXPECT_FALSE(c.rig.learned_any());
  EXPECT_EQ(c.values.T_body_camera.p, stated.T_body_camera.p);
  EXPECT_EQ(c.values.offset, stated.camera_time_offset);
  EXPECT_NEAR(std::sqrt(c.covariance(0, 0)), 0.002, 1e-9);  // as the rig file says
  EXPECT_NEAR(std::sqrt(c.covariance(3, 3)), 0.002, 1e-9);
}

TEST(CameraImuCalibration, ARigFileThatIsRightIsKeptButForChance) {
  Recording recording;
  recording.motion = test::Lively;
  recording.seconds = 5;
  recording.imu_noise = 2;
  const CameraImuCalibration c = CalibrateCameraImu(recording.Camera(), recording.Imu(), recording.rig);
  ASSERT_TRUE(c.success) << c.reason;
  Print(recording, c);
  EXPECT_TRUE(c.rig.learned_any());
  for (const RigDirection& d : c.rig.directions) EXPECT_FALSE(d.moved);
  EXPECT_EQ(c.values.T_body_camera.p, recording.rig.T_body_camera.p);
  EXPECT_EQ(c.values.offset, recording.rig.camera_time_offset);
}

TEST(CameraImuCalibration, SaysWhyItCannot) {
  Recording recording;
  recording.seconds = 5;
  EXPECT_THAT(CalibrateCameraImu(recording.Camera(), {}, recording.rig).reason, HasSubstr("no IMU samples"));
  EXPECT_THAT(CalibrateCameraImu({}, recording.Imu(), recording.rig).reason, HasSubstr("less than 3 s"));
  Recording other = recording;
  other.motion = [](Utime t) { return test::Lively(t + 777'000'000); };
  const CameraImuCalibration c = CalibrateCameraImu(recording.Camera(), other.Imu(), recording.rig);
  EXPECT_FALSE(c.success);
  EXPECT_THAT(c.reason, HasSubstr("belong together"));
}

}  // namespace
}  // namespace evit
