#include "tools/formats/calibration_files/basalt_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/helpers/temporary_folder.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr char kText[] = R"({"value0": {
  "T_imu_cam": [{"px": 9, "py": 9, "pz": 9, "qx": 0, "qy": 0, "qz": 0, "qw": 1},
                {"px": 0.1, "py": -0.2, "pz": 0.3, "qx": 0.6, "qy": 0, "qz": 0, "qw": 0.8}],
  "intrinsics": [{"camera_type": "kb4", "intrinsics": {"fx": 1, "fy": 1, "cx": 1, "cy": 1, "k1": 0, "k2": 0, "k3": 0, "k4": 0}},
                 {"camera_type": "kb4", "intrinsics": {"fx": 1050, "fy": 1051, "cx": 641, "cy": 362, "k1": 0.1, "k2": 0.2, "k3": 0.3, "k4": 0.4}}],
  "resolution": [[1024, 1024], [1280, 720]],
  "imu_update_rate": 200.0,
  "accel_noise_std": [0.01, 0.02, 0.03], "gyro_noise_std": [0.001, 0.001, 0.001],
  "accel_bias_std": [0.0001, 0.0001, 0.0001], "gyro_bias_std": [0.00001, 0.00001, 0.00001],
  "cam_time_offset_ns": 1500000}})";

TEST(BasaltCalibration, TheEventCameraIsFoundByItsSize) {
  const TemporaryFolder folder("basalt");
  const std::string path = folder.Write("calibration.json", kText);
  const Rig rig = ReadBasaltCalibration(path, 1280, 720);
  EXPECT_EQ(rig.camera.model, Camera::Model::kEquidistant);
  EXPECT_EQ(rig.camera.fx, 1050);
  EXPECT_EQ(rig.camera.cy, 362);
  EXPECT_EQ(rig.camera.distortion[3], 0.4);
  EXPECT_EQ(rig.T_body_camera.p, Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_TRUE(rig.T_body_camera.q.coeffs().isApprox(Eigen::Vector4d(0.6, 0, 0, 0.8)));
  EXPECT_DOUBLE_EQ(rig.imu_noise.accel_density, 0.02);
  EXPECT_EQ(rig.imu_rate_hz, 200);
  EXPECT_EQ(rig.camera_time_offset, 1500);
  EXPECT_THAT(
      [&] { ReadBasaltCalibration(path, 640, 480); },
      ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(path), HasSubstr("640x480"), HasSubstr("1280x720"))));
  EXPECT_THAT([&] { ReadBasaltCalibration(folder.Write("a.json", "{\"value0\": {}}"), 640, 480); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("a.json"), HasSubstr("resolution"))));
}

}  // namespace
}  // namespace evit::formats
