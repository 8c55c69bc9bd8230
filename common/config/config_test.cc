// The files in config/ load; every fault in one is named with file, place and remedy.
#include "common/config/config.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace evit {
namespace {

const std::string kConfig = EVIT_SOURCE_DIR "/config/";

std::string ReadFile(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// `text` with its only occurrence of `from` made `to`.
std::string Edited(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class ConfigTest : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = ::testing::TempDir() + "evit_" + ::testing::UnitTest::GetInstance()->current_test_info()->name();
  }
  void TearDown() override { std::remove(path_.c_str()); }

  // Expects that the loader refuses the text, naming the file and each of the words.
  template <typename Load>
  void ExpectRefused(Load load, const std::string& text, const std::vector<std::string>& words) {
    std::ofstream(path_) << text;
    try {
      load(path_);
      ADD_FAILURE() << "not refused; wanted a complaint with " << words.front();
    } catch (const ConfigError& error) {
      EXPECT_EQ(std::string(error.what()).find(path_), 0u) << error.what();
      for (const std::string& word : words) {
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
      }
    }
  }
  std::string path_;
};

TEST_F(ConfigTest, EveryCommittedFileLoads) {
  EXPECT_NO_THROW(LoadTracker(kConfig + "tracker.textproto"));
  EXPECT_NO_THROW(LoadRig(kConfig + "vector/rig.textproto"));
  EXPECT_NO_THROW(LoadRig(EVIT_SOURCE_DIR "/logs/rig.textproto"));
}

TEST_F(ConfigTest, VectorRigHasTheFiguresOfVectorsCalibration) {
  const Rig rig = LoadRig(kConfig + "vector/rig.textproto");
  EXPECT_EQ(rig.camera.width, 640);
  EXPECT_DOUBLE_EQ(rig.camera.fx, 327.32749);
  EXPECT_DOUBLE_EQ(rig.camera.distortion[1], 0.041966);
  EXPECT_DOUBLE_EQ(rig.imu_noise.accel_random_walk, 5.6386016813618435e-05);
  EXPECT_DOUBLE_EQ(rig.imu_rate_hz, 200);
  // The chain of data/README: T_marker_body * T_body_camera is the camera in the marker's frame. The lever
  // arms are those of a hand-held rig.
  EXPECT_LT((rig.T_marker_body * rig.T_body_camera).p.norm(), 0.3);
  // Camera forward (z) is the IMU's x axis within two degrees.
  EXPECT_GT((rig.T_body_camera.q * Eigen::Vector3d::UnitZ()).x(), std::cos(2 * EIGEN_PI / 180));
}

TEST_F(ConfigTest, UnknownMisspeltAndMissingKeys) {
  const std::string rig = ReadFile(kConfig + "vector/rig.textproto");
  const std::string tracker = ReadFile(kConfig + "tracker.textproto");
  ExpectRefused(LoadRig, Edited(rig, "gyro_random_walk", "gyro_randomwalk"), {":2", "gyro_randomwalk"});
  ExpectRefused(LoadRig, Edited(rig, "gravity: 9.81", ""), {"missing", "gravity"});
  ExpectRefused(LoadRig, Edited(rig, "  fx: 327.32749", ""), {"missing", "camera.fx"});
  ExpectRefused(LoadTracker, Edited(tracker, "  size: 5", ""), {"missing", "window.size"});
  ExpectRefused(LoadTracker, tracker + "\nwindows { }", {"windows", "common/config"});
  ExpectRefused(LoadTracker, "", {"missing", "keyframes"});
}

TEST_F(ConfigTest, WrongTypesAndValues) {
  const std::string rig = ReadFile(kConfig + "vector/rig.textproto");
  const std::string tracker = ReadFile(kConfig + "tracker.textproto");
  ExpectRefused(LoadRig, Edited(rig, "width: 640", "width: \"640\""), {":7:10:", "integer", "640"});
  ExpectRefused(LoadRig, Edited(rig, "plumb_bob", "fisheye"), {"camera.model", "fisheye", "equidistant"});
  ExpectRefused(LoadRig, Edited(rig, "fx: 327.32749", "fx: -1"), {"camera.fx"});
  ExpectRefused(LoadRig, Edited(rig, "fx: 327.32749", "fx: nan"), {"camera.fx"});
  ExpectRefused(LoadRig, Edited(rig, ", -0.001031, 0.0]", "]"), {"camera.distortion"});
  ExpectRefused(LoadRig, Edited(rig, "0.999698612512", "0.9"), {"T_body_camera.m", "not a rotation"});
  ExpectRefused(LoadRig, Edited(rig, "  m: [0, 0, 0, 1]\n}", "}"), {"T_body_camera.m", "16 numbers", "12"});
  ExpectRefused(LoadRig, Edited(rig, "gravity: 9.81", "gravity: 981"), {"gravity"});
  ExpectRefused(LoadTracker, Edited(tracker, "kind: SYMMETRIC", "kind: ACAUSAL"), {"ACAUSAL"});
  ExpectRefused(LoadTracker, Edited(tracker, "image_sigma: 80", "image_sigma: 0"), {"window.image_sigma"});
  ExpectRefused(LoadTracker, Edited(tracker, "size: 5 ", "size: 1 "), {"window.size"});
  ExpectRefused(LoadTracker, Edited(tracker, "min_decay_ms: 2 ", "min_decay_ms: 20"), {"min_decay_ms"});
}

TEST_F(ConfigTest, AFileThatIsNotThere) {
  EXPECT_THROW(LoadRig("/nonexistent/rig.textproto"), ConfigError);
  EXPECT_THROW(LoadTracker(kConfig), ConfigError) << "a folder";
}

// A left-handed or transposed rotation is the classic mistake of a hand-copied calibration.
TEST_F(ConfigTest, AMirroredRotationIsRefused) {
  ExpectRefused(LoadRig,
                Edited(ReadFile(kConfig + "vector/rig.textproto"),
                       "[0.0188022409695, -0.999589203474, 0.0216309970154,",
                       "[-0.0188022409695, 0.999589203474, -0.0216309970154,"),
                {"T_body_camera.m", "right-handed"});
}

}  // namespace
}  // namespace evit
