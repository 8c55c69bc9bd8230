#include "tools/formats/calibration_files/read_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/helpers/h5_files.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Doubles = std::vector<double>;

CalibrationChoice Choice(int width, int height) {
  CalibrationChoice choice;
  choice.width = width;
  choice.height = height;
  return choice;
}

void PutText(H5Maker* file, const std::string& name, const std::string& text) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, text.size());
  file->Put(name, type, type, text.data(), {1});
  H5Tclose(type);
}

// The IMU is 1 m to the right of the left camera and looks to where the camera's x axis points; the right
// camera is 0.1 m to the right of the left one.
std::string M3ed(const TemporaryFolder& folder) {
  const std::string path = folder.File("data.h5");
  H5Maker file(path);
  file.Put("ovc/imu/calib/T_to_prophesee_left", H5T_IEEE_F64LE,
           Doubles{0, 0, 1, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1}, 16);
  for (const bool right : {false, true}) {
    const std::string group = std::string("prophesee/") + (right ? "right" : "left") + "/calib/";
    file.Put(group + "intrinsics", H5T_IEEE_F64LE, Doubles{1034, 1033, right ? 600. : 629, 357});
    file.Put(group + "distortion_coeffs", H5T_IEEE_F64LE, Doubles{0.1, 0.2, 0.3, 0.4});
    file.Put(group + "resolution", H5T_STD_I64LE, std::vector<std::int64_t>{1280, 720});
    file.Put(group + "T_to_prophesee_left", H5T_IEEE_F64LE,
             Doubles{1, 0, 0, right ? 0.1 : 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 16);
    PutText(&file, group + "distortion_model", right ? "equidistant" : "radtan");
  }
  return path;
}

TEST(ReadCalibration, M3edsBothCameras) {
  const TemporaryFolder folder("m3ed");
  const std::string path = M3ed(folder);
  CalibrationChoice choice = Choice(1280, 720);
  const Rig left = ReadCalibration({path}, choice).rig;
  EXPECT_EQ(left.camera.model, Camera::Model::kPlumbBob);
  EXPECT_EQ(left.camera.cx, 629);
  EXPECT_EQ(left.camera.distortion[3], 0.4);
  // The camera's origin is 1 m behind the IMU's, whose z axis is the camera's x axis.
  EXPECT_TRUE(left.T_body_camera.p.isApprox(Eigen::Vector3d(0, 0, -1)));
  EXPECT_TRUE((left.T_body_camera.q * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0, 0, 1)));
  EXPECT_TRUE(left.T_marker_body.p.isApprox(Eigen::Vector3d(1, 0, 0)));  // truth is the left camera's
  EXPECT_EQ(left.imu_rate_hz, 400);
  choice.side = "right";
  const Rig right = ReadCalibration({path}, choice).rig;
  EXPECT_EQ(right.camera.model, Camera::Model::kEquidistant);
  EXPECT_TRUE(right.T_body_camera.p.isApprox(Eigen::Vector3d(0, 0, -0.9)));
  EXPECT_TRUE(right.T_marker_body.p.isApprox(Eigen::Vector3d(1, 0, 0)));
  EXPECT_THAT([&] { ReadCalibration({path}, Choice(640, 480)); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("1280x720"), HasSubstr("640x480"))));
}

constexpr char kDsec[] = R"(intrinsics:
  cam0:
    camera_matrix: [553.46, 553.89, 346.65, 216.52]
    camera_model: pinhole
    distortion_coeffs: [-0.09, 0.15, -0.0003, -0.0002]
    distortion_model: radtan
    resolution: [640, 480]
  cam3:
    camera_matrix:
    - 552.18
    - 552.51
    - 336.87
    - 220.81
    distortion_coeffs: [-0.1, 0.16, 0.0002, 0.0003]
    resolution: [640, 480]
  camRect0:
    camera_matrix: [569.76, 569.76, 335.09, 221.23]
extrinsics:
  T_10:
  - [1.0, 0.0, 0.0, -0.05]
)";

TEST(ReadCalibration, DsecsNeedsWhereTheCameraIs) {
  const TemporaryFolder folder("dsec");
  const std::string path = folder.Write("cam_to_cam.yaml", kDsec);
  CalibrationChoice choice = Choice(640, 480);
  EXPECT_THAT([&] { ReadCalibration({path}, choice); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(path), HasSubstr("--t-body-camera"))));
  choice.T_body_camera = SE3(Eigen::Quaterniond::Identity(), {0.1, 0.2, 0.3});
  const FoundCalibration left = ReadCalibration({path}, choice);
  EXPECT_EQ(left.rig.camera.fx, 553.46);
  EXPECT_EQ(left.rig.camera.distortion[2], -0.0003);
  EXPECT_EQ(left.rig.T_body_camera.p, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_TRUE(left.imu_assumed);
  choice.side = "right";
  EXPECT_EQ(ReadCalibration({path}, choice).rig.camera.fx, 552.18);
}

// As MVSEC publishes it: Kalibr's chain with keys of its own.
TEST(ReadCalibration, MvsecsIsKalibrs) {
  const TemporaryFolder folder("mvsec");
  const std::string path = folder.Write("camchain-imucam-indoor_flying.yaml", R"(cam0:
  T_cam_imu:
  - [0.0, 0.0, 1.0, 0.5]
  - [1.0, 0.0, 0.0, 0.0]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [1, 2, 3]
  camera_model: pinhole
  distortion_coeffs: [-0.048, 0.011, -0.055, 0.021]
  distortion_model: equidistant
  intrinsics: [226.38, 226.15, 173.65, 133.73]
  projection_matrix:
  - [199.09, 0.0, 177.43, 0.0]
  - [0.0, 199.09, 126.81, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  resolution: [346, 260]
  rostopic: /davis/left/image_raw
  timeshift_cam_imu: -0.001
)");
  const FoundCalibration found = ReadCalibration({path}, Choice(346, 260));
  EXPECT_EQ(found.rig.camera.model, Camera::Model::kEquidistant);
  EXPECT_EQ(found.rig.camera.cy, 133.73);
  EXPECT_TRUE(found.rig.T_body_camera.p.isApprox(Eigen::Vector3d(0, 0, -0.5)));
  EXPECT_EQ(found.rig.camera_time_offset, -1000);
  EXPECT_TRUE(found.imu_assumed);
}

TEST(ReadCalibration, TumViesMarkerIsInASecondFile) {
  const TemporaryFolder folder("tumvie");
  const std::string camera = folder.Write("calibrationA.json", R"({"value0": {
    "T_imu_cam": [{"px": 0.1, "py": 0, "pz": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1}],
    "intrinsics": [{"camera_type": "kb4",
      "intrinsics": {"fx": 1050, "fy": 1051, "cx": 641, "cy": 362, "k1": 0, "k2": 0, "k3": 0, "k4": 0}}],
    "resolution": [[1280, 720]], "imu_update_rate": 200.0,
    "accel_noise_std": [0.01, 0.01, 0.01], "gyro_noise_std": [0.001, 0.001, 0.001],
    "accel_bias_std": [0.0001, 0.0001, 0.0001], "gyro_bias_std": [0.00001, 0.00001, 0.00001]}})");
  const std::string marker = folder.Write("mocap-imu-calibrationA.json", R"({"value0": {
    "T_imu_marker": {"px": 0.02, "py": 0, "pz": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1}}})");
  const Rig rig = ReadCalibration({marker, camera}, Choice(1280, 720)).rig;
  EXPECT_EQ(rig.T_body_camera.p.x(), 0.1);
  EXPECT_DOUBLE_EQ(rig.T_marker_body.p.x(), -0.02);
  EXPECT_THAT([&] { ReadCalibration({marker}, Choice(1280, 720)); },
              ThrowsMessage<std::runtime_error>(HasSubstr("expected one calibration with cameras, got 0")));
}

TEST(ReadCalibration, OthersAreRefusedByName) {
  const TemporaryFolder folder("others");
  EXPECT_THAT([&] { ReadCalibration({folder.File("none.json")}, Choice(640, 480)); },
              ThrowsMessage<std::runtime_error>(HasSubstr("there is no such file")));
  EXPECT_THAT(
      [&] {
        ReadCalibration({folder.Write("a.yaml", "cam0:\n  resolution: [640, 480]\n")}, Choice(640, 480));
      },
      ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("a.yaml"), HasSubstr("camera_model"))));
}

}  // namespace
}  // namespace evit::formats
