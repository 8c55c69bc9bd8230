#include "common/config/rig_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "tests/helpers/config_files.h"
#include "tests/helpers/paths.h"

namespace evit {
namespace {

TEST(RigFile, ReadsBackAsItWasWritten) {
  const std::string path = ::testing::TempDir() + "/rig_" + std::to_string(getpid()) + ".textproto";
  Rig rig = LoadRig(test::SourcePath("config/vector/rig.textproto"));
  rig.camera_time_offset = -2'400;
  rig.T_body_camera_sigma = {{0.0123, 0.004, 0}, {0, 0.002, 0.0031}};
  for (const auto model : {Camera::Model::kPlumbBob, Camera::Model::kEquidistant}) {
    rig.camera.model = model;
    WriteRig(path, rig, "a \"quoted\" \\ name", "first line\nsecond line");
    const Rig back = LoadRig(path);
    EXPECT_EQ(back.camera.model, model);
    EXPECT_EQ(back.camera.width, rig.camera.width);
    EXPECT_EQ(back.camera.height, rig.camera.height);
    EXPECT_EQ(back.camera.fx, rig.camera.fx);
    EXPECT_EQ(back.camera.fy, rig.camera.fy);
    EXPECT_EQ(back.camera.cx, rig.camera.cx);
    EXPECT_EQ(back.camera.cy, rig.camera.cy);
    EXPECT_EQ(back.camera.distortion, rig.camera.distortion);
    EXPECT_EQ(back.camera_time_offset, -2'400);
    EXPECT_EQ(back.imu_rate_hz, rig.imu_rate_hz);
    EXPECT_EQ(back.imu_noise.gyro_density, rig.imu_noise.gyro_density);
    EXPECT_EQ(back.imu_noise.accel_density, rig.imu_noise.accel_density);
    EXPECT_EQ(back.imu_noise.gyro_random_walk, rig.imu_noise.gyro_random_walk);
    EXPECT_EQ(back.imu_noise.accel_random_walk, rig.imu_noise.accel_random_walk);
    EXPECT_EQ(back.imu_noise.gyro_range, rig.imu_noise.gyro_range);
    EXPECT_EQ(back.imu_noise.accel_range, rig.imu_noise.accel_range);
    EXPECT_TRUE(back.T_body_camera.R().isApprox(rig.T_body_camera.R(), 1e-12));
    EXPECT_EQ(back.T_body_camera.p, rig.T_body_camera.p);
    EXPECT_TRUE(back.T_body_camera_sigma.rotation.isApprox(rig.T_body_camera_sigma.rotation, 1e-15));
    EXPECT_EQ(back.T_body_camera_sigma.translation, rig.T_body_camera_sigma.translation);
    EXPECT_TRUE(back.T_marker_body.R().isApprox(rig.T_marker_body.R(), 1e-12));
    EXPECT_EQ(back.T_marker_body.p, rig.T_marker_body.p);
    EXPECT_EQ(back.gravity, rig.gravity);
  }
  rig.T_body_camera_sigma = {};
  WriteRig(path, rig, "exact", "");
  EXPECT_EQ(test::ReadText(path).find("sigma"), std::string::npos);
  EXPECT_EQ(LoadRig(path).T_body_camera_sigma.rotation, Eigen::Vector3d::Zero());
  std::filesystem::remove(path);
  EXPECT_THROW(WriteRig("/no/such/rig.textproto", rig, "", ""), std::runtime_error);
}

}  // namespace
}  // namespace evit
