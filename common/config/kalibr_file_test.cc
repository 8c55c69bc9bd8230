#include "common/config/kalibr_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "common/config/rig_file.h"

namespace evit {
namespace {

using ::testing::HasSubstr;

constexpr char kChain[] = R"(cam0:
  T_cam_imu:
  - [0.0, -1.0, 0.0, 0.01]
  - [0.0, 0.0, -1.0, 0.02]
  - [1.0, 0.0, 0.0, 0.03]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.03, 0.04, 0.001, 0.002]
  distortion_model: radtan
  intrinsics: [163.6, 163.7, 152.2, 117.4]
  resolution: [320, 240]
  rostopic: /dvs/image
  timeshift_cam_imu: 0.005
cam1:
  T_cam_imu:
    - [1.0, 0.0, 0.0, 0.5]
    - [0.0, 1.0, 0.0, 0.0]
    - [0.0, 0.0, 1.0, 0.0]
    - [0.0, 0.0, 0.0, 1.0]
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, 0.1]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: pinhole
  distortion_coeffs: [0.1, 0.2, 0.3, 0.4]
  distortion_model: equidistant
  intrinsics: [400, 401,
               320, 240]
  resolution: [640, 480]
)";
constexpr char kImu[] =
    "#Accelerometers\naccelerometer_noise_density: 1.86e-03   # continuous\n"
    "accelerometer_random_walk: 4.33e-04\ngyroscope_noise_density: 1.87e-04\n"
    "gyroscope_random_walk: 2.66e-05\nrostopic: /imu0\nupdate_rate: 400.0\n";

class KalibrFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    Write("camchain.yaml", kChain);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void Write(const std::string& name, const std::string& text) const { std::ofstream(Path(name)) << text; }
  std::string Path(const std::string& name) const { return folder_ + "/" + name; }
  std::string Error(const std::string& from, const std::string& to) const {
    std::string text = kChain;
    text.replace(text.find(from), from.size(), to);
    Write("bad.yaml", text);
    try {
      LoadRig(Path("bad.yaml"));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  const std::string folder_ = ::testing::TempDir() + "kalibr_" + std::to_string(getpid());
};

TEST_F(KalibrFileTest, TheExtrinsicsAreInvertedAndTheShiftIsMicroseconds) {
  const Rig rig = LoadRig(Path("camchain.yaml"));
  EXPECT_EQ(rig.camera.width, 320);
  EXPECT_EQ(rig.camera.fy, 163.7);
  EXPECT_EQ(rig.camera.cx, 152.2);
  EXPECT_EQ(rig.camera.model, Camera::Model::kPlumbBob);
  EXPECT_EQ(rig.camera.distortion[3], 0.002);
  EXPECT_EQ(rig.camera_time_offset, 5'000);
  // The camera's z axis is the IMU's x; the IMU's origin, in the camera at (0.01, 0.02, 0.03).
  EXPECT_TRUE((rig.T_body_camera.q * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_LT((rig.T_body_camera * Eigen::Vector3d(0.01, 0.02, 0.03)).norm(), 1e-12);
  EXPECT_EQ(rig.imu_noise.gyro_density, kConsumerImuNoise.gyro_density);
  EXPECT_THAT(LoadRigName(Path("camchain.yaml")), HasSubstr("consumer IMU"));
}

// As PyYAML writes lists since version 5.1.
TEST_F(KalibrFileTest, ListsMayStandOneNumberALine) {
  std::string text = kChain;
  const std::size_t begin = text.find("  - [0.0, -1.0"), end = text.find("  cam_overlaps");
  text.replace(begin, end - begin,
               "  - - 0.0\n    - -1.0\n    - 0.0\n    - 0.01\n  - - 0.0\n    - 0.0\n    - -1.0\n    - 0.02\n"
               "  - - 1.0\n    - 0.0\n    - 0.0\n    - 0.03\n  - - 0.0\n    - 0.0\n    - 0.0\n    - 1.0\n");
  const std::string flow = "[163.6, 163.7, 152.2, 117.4]";
  text.replace(text.find(flow), flow.size(), "\n  - 163.6\n  - 163.7\n  - 152.2\n  - 117.4");
  Write("block.yaml", text);
  const Rig block = LoadRig(Path("block.yaml")), rig = LoadRig(Path("camchain.yaml"));
  EXPECT_TRUE(block.T_body_camera.p.isApprox(rig.T_body_camera.p));
  EXPECT_TRUE(block.T_body_camera.q.isApprox(rig.T_body_camera.q));
  EXPECT_EQ(block.camera.cx, rig.camera.cx);
}

TEST_F(KalibrFileTest, ImuFileAndCameraCanBeChosen) {
  Write("imu.yaml", kImu);
  for (const std::string& path :
       {Path("camchain.yaml") + "#cam1," + Path("imu.yaml"), Path("camchain.yaml") + "#cam1"}) {
    const Rig rig = LoadRig(path);
    EXPECT_EQ(rig.camera.width, 640);
    EXPECT_EQ(rig.camera.cy, 240);
    EXPECT_EQ(rig.camera.model, Camera::Model::kEquidistant);
    EXPECT_EQ(rig.T_body_camera.p, Eigen::Vector3d(-0.5, 0, 0));
    EXPECT_EQ(rig.imu_noise.accel_density, 1.86e-3);
    EXPECT_EQ(rig.imu_noise.gyro_random_walk, 2.66e-5);
    EXPECT_EQ(rig.imu_rate_hz, 400);
  }
  Write("imu.yaml",
        std::string("imu0:\n  accelerometer_noise_density: 0.01\n  accelerometer_random_walk: 0.001\n  "
                    "gyroscope_noise_density: 0.002\n  gyroscope_random_walk: 0.0001\n  update_rate: 100\n"));
  EXPECT_EQ(LoadRig(Path("camchain.yaml")).imu_rate_hz, 100);
}

TEST_F(KalibrFileTest, FaultsAreNamed) {
  EXPECT_THAT(Error("camera_model: pinhole", "camera_model: omni"), HasSubstr("cam0.camera_model"));
  EXPECT_THAT(Error("model: radtan", "model: fov"), HasSubstr("pinhole-radtan"));
  EXPECT_THAT(Error("T_cam_imu", "T_cam_x"), HasSubstr("kalibr_calibrate_imu_camera"));
  EXPECT_THAT(Error("[0.0, -1.0, 0.0, 0.01]", "[0.0, -2.0, 0.0, 0.01]"), HasSubstr("not a rigid"));
  EXPECT_THAT(Error("shift_cam_imu: 0.005", "shift_cam_imu: 5000"), HasSubstr("less than a second"));
  EXPECT_THAT(Error("[320, 240]", "[320]"), HasSubstr("2 values are expected, got 1"));
  EXPECT_THAT(Error("163.6", "x"), HasSubstr("\"x\" is not a number"));
}

}  // namespace
}  // namespace evit
