// Rig files load; every fault in one is named with file, line, field and remedy.
#include <cmath>

#include "common/config/rig_file.h"
#include "common/geometry/degrees.h"
#include "tests/helpers/config_files.h"
#include "tests/helpers/paths.h"

namespace evit {
namespace {

using test::Edited;

const std::string kRig = test::SourcePath("config/vector/rig.textproto");

class RigReading : public test::ConfigFilesTest {
 protected:
  // Expects that the shipped rig is refused with one text in place of another.
  void ExpectEditRefused(const std::string& from, const std::string& to, const std::string& place,
                         const std::vector<std::string>& words) {
    ExpectRefused(LoadRig, Write("rig.textproto", Edited(test::ReadText(kRig), from, to)), place, words);
  }
};

TEST_F(RigReading, SecondsPastedAsMicrosecondsAreNoticed) {
  ExpectEditRefused("time_offset_us: 0", "time_offset_us: 0.0054", ":14",
                    {"time_offset_us", "looks like seconds", "5400"});
  ExpectEditRefused("time_offset_us: 0", "time_offset_us: 5400000", ":14", {"more than a second"});
}

TEST_F(RigReading, ShippedFilesLoad) {
  EXPECT_NO_THROW(LoadRig(kRig));
  EXPECT_NO_THROW(LoadRig(test::SourcePath("logs/rig.textproto")));
}

TEST_F(RigReading, VectorRigHasTheFiguresOfVectorsCalibration) {
  const Rig rig = LoadRig(kRig);
  EXPECT_EQ(rig.camera.width, 640);
  EXPECT_DOUBLE_EQ(rig.camera.fx, 327.32749);
  EXPECT_DOUBLE_EQ(rig.camera.distortion[1], 0.041966);
  EXPECT_DOUBLE_EQ(rig.imu_noise.accel_random_walk, 5.6386016813618435e-05);
  EXPECT_DOUBLE_EQ(rig.imu_rate_hz, 200);
  // T_marker_body * T_body_camera is the camera in the marker's frame. The lever arms are those of a
  // hand-held rig.
  EXPECT_LT((rig.T_marker_body * rig.T_body_camera).p.norm(), 0.3);
  // Camera forward (z) is the IMU's x axis within two degrees.
  EXPECT_GT((rig.T_body_camera.q * Eigen::Vector3d::UnitZ()).x(), std::cos(2 * kRadiansPerDegree));
}

TEST_F(RigReading, UnknownAndMissingKeysAreNamed) {
  ExpectEditRefused("gyro_random_walk", "gyro_randomwalk", ":21:3",
                    {"imu.gyro_randomwalk", "did you mean imu.gyro_random_walk?"});
  ExpectEditRefused("gravity: 9.81", "", "", {"missing", "gravity"});
  ExpectEditRefused("  fx: 327.32749", "", "", {"missing", "camera.fx"});
}

TEST_F(RigReading, WrongTypesAreNamedWithWhatIsAllowed) {
  ExpectEditRefused("width: 640", "width: \"640\"", ":7:3", {"camera.width", "integer", "16 to 8192 px"});
}

TEST_F(RigReading, ValuesOutOfRangeAreNamedWithTheirLine) {
  ExpectEditRefused("plumb_bob", "fisheye", ":6", {"camera.model", "fisheye", "equidistant"});
  ExpectEditRefused("plumb_bob", "rational_polynomial", ":6", {"camera.model", "k1 to k6", "undistort"});
  ExpectEditRefused(", -0.001031, 0.0]", ", -0.001031, 0.0, 0.4, -2.5, 1.5]", ":6",
                    {"camera.model", "k1 to k6", "undistort"});
  // A name that is not known says nothing of the model, however many numbers there are.
  const std::string eight =
      Edited(test::ReadText(kRig), ", -0.001031, 0.0]", ", -0.001031, 0.0, 0.4, -2.5, 1.5]");
  ExpectRefused(LoadRig, Write("rig.textproto", Edited(eight, "plumb_bob", "double_sphere")), ":6",
                {"camera.model", "double_sphere", "not known"});
  ExpectRefused(LoadRig, Write("rig.textproto", Edited(eight, "plumb_bob", "radtan")), ":6",
                {"camera.model", "k1 to k6"});
  ExpectEditRefused("fx: 327.32749", "fx: -1", ":9", {"camera.fx", "-1", "above 0 px"});
  ExpectEditRefused("fx: 327.32749", "fx: nan", ":9", {"camera.fx"});
  ExpectEditRefused(", -0.001031, 0.0]", "]", ":13", {"camera.distortion", "4 or 5"});
  ExpectEditRefused("gravity: 9.81", "gravity: 981", "", {"gravity", "981", "above 9, below 10.5 m/s^2"});
}

TEST_F(RigReading, TransformationsMustBeRigid) {
  ExpectEditRefused("0.999698612512", "0.9", "", {"T_body_camera.m", "not a rotation"});
  ExpectEditRefused("  m: [0, 0, 0, 1]\n}", "}", "", {"T_body_camera.m", "16 numbers", "12"});
}

constexpr char kSigma[] = "rotation_deg: [0.8, 0.8, 0.8]";

TEST_F(RigReading, ExtrinsicsAreExactlyKnownUnlessTheirStandardDeviationsAreGiven) {
  const auto load = [&](const std::string& sigma) {
    return LoadRig(Write("rig.textproto", Edited(test::ReadText(kRig), kSigma, sigma))).T_body_camera_sigma;
  };
  const ExtrinsicsSigma exact = load(""), turned = load("rotation_deg: [0.5, 1, 2]"),
                        moved = load("translation_m: [0.001, 0, 0.002]");
  EXPECT_EQ(exact.rotation.norm() + exact.translation.norm(), 0);
  EXPECT_NEAR(turned.rotation.z(), 2 * kRadiansPerDegree, 1e-15);
  EXPECT_NEAR(turned.rotation.x(), 0.5 * kRadiansPerDegree, 1e-15);
  EXPECT_EQ(turned.translation.norm() + moved.rotation.norm(), 0);
  EXPECT_EQ(moved.translation, Eigen::Vector3d(0.001, 0, 0.002));
}

TEST_F(RigReading, ImpossibleStandardDeviationsAreRefused) {
  ExpectEditRefused(kSigma, "rotation_deg: [0.8, -0.8, 0.8]", ":39",
                    {"T_body_camera_sigma.rotation_deg", "-0.8", "0 to 20 deg"});
  ExpectEditRefused(kSigma, "rotation_deg: [0.8, 80, 0.8]", ":39", {"80 is out of range", "0 to 20 deg"});
  ExpectEditRefused(kSigma, "rotation_deg: [0.8, nan, 0.8]", ":39", {"T_body_camera_sigma.rotation_deg"});
  ExpectEditRefused(kSigma, "rotation_deg: 0.8", ":39",
                    {"T_body_camera_sigma.rotation_deg", "3 numbers are expected (x, y, z), got 1"});
  ExpectEditRefused(kSigma, "translation_m: [2, 2, 2]", ":39",  // millimetres
                    {"T_body_camera_sigma.translation_m", "0 to 1 m"});
  ExpectEditRefused(kSigma, "rotation: [1, 1, 1]", ":39", {"no such key", "rotation_deg"});
}

// A left-handed or transposed rotation is the classic mistake of a hand-copied calibration.
TEST_F(RigReading, AMirroredRotationIsRefused) {
  ExpectEditRefused("[0.0188022409695, -0.999589203474, 0.0216309970154,",
                    "[-0.0188022409695, 0.999589203474, -0.0216309970154,", "",
                    {"T_body_camera.m", "right-handed"});
}

TEST_F(RigReading, AFileThatIsNotThereIsNamed) {
  ExpectRefused(LoadRig, "/nonexistent/rig.textproto", "", {"cannot be read"});
}

}  // namespace
}  // namespace evit
