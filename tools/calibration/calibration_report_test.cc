#include "tools/calibration/calibration_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>

#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/config/rig_file.h"
#include "tests/helpers/paths.h"
#include "tests/helpers/sample_messages.h"
#include "tools/calibration/recorded_motion.h"

namespace evit::calibration {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Rig Before() { return LoadRig(test::SourcePath("config/vector/rig.textproto")); }

CameraImuCalibration Found() {
  CameraImuCalibration c;
  c.success = true;
  c.values.T_body_camera = Before().T_body_camera;
  c.values.T_body_camera.p.x() += 0.0105;
  c.values.T_body_camera.q = c.values.T_body_camera.q * ExpSO3({0, 0.02, 0});
  c.values.offset = -4'321;
  c.values.tilt = {0.02, 0};
  c.covariance.diagonal().setConstant(1e-6);
  c.prior_sigma = RigPriorSigma(Before());
  RigVector found;
  found << 0.0105, 0, 0, 0, 0.02, 0, -0.004321;
  RigVector sigma = RigVector::Constant(1e-3);
  sigma[2] = 0.0099;  // along the body's z next to nothing
  c.rig = UpdateRig(c.prior_sigma, 0, found, sigma.cwiseAbs2().asDiagonal());
  c.covariance(2, 2) = c.rig.covariance(2, 2);
  return c;
}

TEST(CalibrationReport, TextNamesEachValueAndWhatWasLearned) {
  CameraImuCalibration c = Found();
  c.unobservable.push_back({Unobservable::Value::kGyroBias, {0, 0, 1}, 0.02});
  EXPECT_THAT(
      CalibrationText(Before(), c),
      AllOf(HasSubstr("139.575"), HasSubstr("129.075"), HasSubstr("-4.321"), HasSubstr("1.146"),
            HasSubstr("moved by 10.5 mm"), HasSubstr("10.000       25.086   10.000  kept"),
            HasSubstr("1.000  learned"),
            HasSubstr("not observable from this motion, kept: translation along (0.00, 0.00, 1.00) of the "
                      "body, known to 0.99 of the rig file's sigma"),
            HasSubstr("learned, moved: time offset, off by 0.86 +- 0.20 of"),
            HasSubstr("not observable: gyro bias along (0.00, 0.00, 1.00) of the body, known to 20 mrad/s"),
            Not(HasSubstr("draws the result"))));
}

TEST(CalibrationReport, ARigFileThatIsFartherOffThanItSaysIsNamed) {
  CameraImuCalibration c = Found();
  c.rig.change[4] = 0.1;
  EXPECT_THAT(CalibrationText(Before(), c), HasSubstr("the rig file is off by 7.3 of its sigmas"));
}

TEST(CalibrationReport, ARigFromWhichNothingWasLearnedIsTheOneBefore) {
  CameraImuCalibration c = Found();
  const RigVector sigma = 0.9 * c.prior_sigma;
  c.rig = UpdateRig(c.prior_sigma, 0, c.prior_sigma, sigma.cwiseAbs2().asDiagonal());
  const Rig rig = Calibrated(Before(), c);
  EXPECT_EQ(rig.T_body_camera.p, Before().T_body_camera.p);
  EXPECT_EQ(rig.T_body_camera_sigma.translation, Before().T_body_camera_sigma.translation);
}

TEST(CalibrationReport, RigFileHoldsWhatWasFoundAndWhereItIsFrom) {
  const std::string path = ::testing::TempDir() + "calibrated_" + std::to_string(getpid()) + ".textproto";
  const Rig rig = Calibrated(Before(), Found());
  const std::string comment = RigComment(Before(), Found(), "from a.lcmlog");
  WriteRig(path, rig, "mine", comment);
  const Rig read = LoadRig(path);
  EXPECT_EQ(LoadRigName(path), "mine");
  std::remove(path.c_str());
  EXPECT_THAT(comment, AllOf(HasSubstr("from a.lcmlog"), HasSubstr("139.575, was 129.075, sigma 1.000")));
  EXPECT_EQ(read.camera_time_offset, -4'321);
  EXPECT_LT((read.T_body_camera.p - Found().values.T_body_camera.p).norm(), 1e-12);
  EXPECT_LT(AngularDistance(read.T_body_camera.q, Found().values.T_body_camera.q), 1e-7);
  EXPECT_NEAR(read.T_body_camera_sigma.translation.x(), 1e-3, 1e-12);
  EXPECT_NEAR(read.T_body_camera_sigma.rotation.y(), 1e-3, 1e-12);
  EXPECT_EQ(read.imu_noise.gyro_density, Before().imu_noise.gyro_density);
}

TEST(CalibrationReport, SignificantTiltIsReportedWithTheMatrixThatTurnsTheMapUpright) {
  CameraImuCalibration c = Found();
  const std::string advice = TiltAdvice(c, "a/desk.ply", {});
  EXPECT_THAT(advice,
              AllOf(HasSubstr("1.15 deg"), HasSubstr("evit map import a/desk.ply a/desk_upright.pcd")));
  double m[9] = {0};
  ASSERT_EQ(std::sscanf(advice.c_str() + advice.find("--transform \"") + 13,
                        "%lf %lf %lf 0 %lf %lf %lf 0 %lf %lf %lf", m, m + 1, m + 2, m + 3, m + 4, m + 5,
                        m + 6, m + 7, m + 8),
            9);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(m);
  const Eigen::Vector3d up_in_map = ExpSO3({0.02, 0, 0}) * Eigen::Vector3d::UnitZ();
  EXPECT_LT((R * up_in_map - Eigen::Vector3d::UnitZ()).norm(), 1e-8);

  c.covariance.diagonal().setConstant(1e-3);
  EXPECT_EQ(TiltAdvice(c, "a/desk.ply", {}), "");  // may well be none
  c.covariance.diagonal().setConstant(1e-12);
  c.values.tilt = {5e-4, 0};
  EXPECT_EQ(TiltAdvice(c, "a/desk.ply", {}), "");  // sure, but of no account
}

TEST(RecordedMotion, ReadsTheImuOfALogWithoutWhatIsBeyondItsRange) {
  const std::string path = ::testing::TempDir() + "imu_" + std::to_string(getpid()) + ".lcmlog";
  {
    LogWriter log(path);
    std::vector<std::uint8_t> bytes;
    for (int k = 0; k < 5; ++k) {
      auto imu = Sample<imu_batch_t>(1);
      imu.utime = imu.sample_utime[0] = 1'000'000 + 5'000 * k;
      imu.gyro[0] = {0.1 * k, 0, k == 3 ? 9.0 : 0.0};
      EncodeTo(imu, &bytes);
      log.Write(imu.utime, k == 1 ? "OTHER" : "robot.IMU", bytes.data(), bytes.size());
    }
    log.Write(2'000'000, "robot.IMU", "rubbish", 7);
    log.Write(2'000'000, "robot.EVENTS", "rubbish", 7);  // whose prefix is the recording's
    log.Close();
  }
  const std::vector<ImuSample> samples = ReadImu(path, Before().imu_noise);
  std::remove(path.c_str());
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_EQ(samples[1].t, 1'010'000);
  EXPECT_EQ(samples[2].gyro.x(), 0.4);
}

TEST(RecordedMotion, CameraDependsOnNeitherExtrinsicsNorOffset) {
  const Rig a = Before(), b = Calibrated(Before(), Found());
  const SE3 camera(ExpSO3({1, 2, 0.3}), {1, 2, 3});
  for (const Rig& rig : {a, b}) {
    const Trajectory body{{5'000'000 + rig.camera_time_offset, camera * rig.T_body_camera.Inverse()}};
    const Trajectory back = CameraOf(body, rig);
    EXPECT_EQ(back[0].t, 5'000'000);
    EXPECT_LT((back[0].pose.p - camera.p).norm(), 1e-12);
    EXPECT_LT(AngularDistance(back[0].pose.q, camera.q), 1e-7);
  }
}

}  // namespace
}  // namespace evit::calibration
