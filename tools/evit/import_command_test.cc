// `evit import`, the program.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "common/config/rig_file.h"
#include "common/evaluation/trajectory.h"
#include "tests/helpers/h5_files.h"
#include "tests/helpers/run_evit.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::commands {
namespace {

using ::testing::HasSubstr;
using Doubles = std::vector<double>;
using Integers = std::vector<std::int64_t>;

class ImportCommandTest : public ::testing::Test {
 protected:
  /// What `evit import ARGUMENTS` prints on both streams; its exit code is compared.
  static std::string Import(const std::string& arguments, int expected_code) {
    const test::ProgramOutcome outcome = test::RunEvit("import " + arguments);
    EXPECT_EQ(outcome.code, expected_code) << outcome.output;
    return outcome.output;
  }

  const TemporaryFolder folder_{"import_command"};
  const std::string log_ = folder_.File("a.lcmlog");
};

// M3ED's: the events, the IMU, the truth of the left camera and the calibration of a falcon.
std::string M3edFile(const TemporaryFolder& folder) {
  std::string path = folder.File("falcon.h5");
  H5Maker file(path);
  file.Put("prophesee/left/x", H5T_STD_U16LE, Integers{0, 1279, 2});
  file.Put("prophesee/left/y", H5T_STD_U16LE, Integers{719, 0, 3});
  file.Put("prophesee/left/t", H5T_STD_I64LE, Integers{10, 2000, 9000});
  file.Put("prophesee/left/p", H5T_STD_U8LE, Integers{1, 0, 1});
  const std::string calib = "prophesee/left/calib/";
  file.Put(calib + "resolution", H5T_STD_I64LE, Integers{1280, 720});
  file.Put(calib + "intrinsics", H5T_IEEE_F64LE, Doubles{1034, 1033, 629, 357});
  file.Put(calib + "distortion_coeffs", H5T_IEEE_F64LE, Doubles{0.1, 0.2, 0.3, 0.4});
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, 6);
  file.Put(calib + "distortion_model", text, text, "radtan", {1});
  H5Tclose(text);
  file.Put(calib + "T_to_prophesee_left", H5T_IEEE_F64LE,
           Doubles{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 16);
  file.Put("ovc/imu/calib/T_to_prophesee_left", H5T_IEEE_F64LE,
           Doubles{1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 16);
  file.Put("ovc/imu/accel", H5T_IEEE_F64LE, Doubles{0, 0, 9.81, 0, 0, 9.81, 0, 0, 9.81}, 3);
  file.Put("ovc/imu/omega", H5T_IEEE_F64LE, Doubles{0, 0, 0.1, 0, 0, 0.1, 0, 0, 0.1}, 3);
  file.Put("ovc/imu/ts", H5T_STD_I64LE, Integers{0, 2500, 5000});
  file.Put("Cn_T_C0", H5T_IEEE_F64LE, Doubles{1, 0, 0, -3, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,  //
                                              1, 0, 0, -4, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
           16);
  file.Put("ts", H5T_STD_I64LE, Integers{2500, 5000});
  return path;
}

TEST_F(ImportCommandTest, ACalibrationBecomesARigFileAndTurnsTheTruthIntoTheImus) {
  const std::string path = M3edFile(folder_), rig_path = folder_.File("rig.textproto");
  const std::string text =
      Import(path + " --calibration " + path + " --rig-out " + rig_path + " --out " + log_, 0);
  EXPECT_THAT(text, HasSubstr(rig_path + ": rig of M3ED's"));
  const Rig rig = LoadRig(rig_path);
  EXPECT_EQ(rig.camera.fx, 1034);
  EXPECT_DOUBLE_EQ(rig.T_body_camera.p.x(), -0.5);
  EXPECT_DOUBLE_EQ(rig.T_marker_body.p.x(), 0.5);
  // The camera is at x = 3, the IMU half a metre further.
  const Trajectory truth = ReadTum(log_ + ".truth.tum");
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_DOUBLE_EQ(truth[0].pose.p.x(), 3.5);
}

TEST_F(ImportCommandTest, AReaderThatGoesAwayDoesNotSpoilTheLog) {
  Import(M3edFile(folder_) + " --out " + log_ + " 2>&1 | true", 0);
  EXPECT_TRUE(std::filesystem::exists(log_));
  EXPECT_FALSE(std::filesystem::exists(log_ + ".part"));
}

TEST_F(ImportCommandTest, WhatIsNoRecordingIsNamedWithItsRemedy) {
  const std::string text = "1600000000.0 0.1 0.1 0.1 0.1 0.2 9.8\n";
  const std::pair<std::string, const char*> cases[] = {
      {"", "is empty"},
      {"\x1f\x8b\b", "gunzip"},
      {std::string("PK\x03\x04") + std::string(26, '.') + "t.npy", "not a complete archive"},
      {std::string("PK\x03\x04") + std::string(26, '.') + "events.txt", "unzip"},
      {"\x89PNG\r\n", "is a picture"},
      {std::string(4, ' ') + "ftypisom", "is a video"},
      {"<!DOCTYPE html>", "is a web page"},
      {"version https://git-lfs.github.com/spec/v1", "git lfs pull"},
      {"# .PCD v0.7\n", "is a map"},
      {" {\"value0\": 1}", "--calibration"},
      {text + text, "--imu"},
      {std::string("12 34 56 78 1 2 3 4\n\0\1\2\3 5 6 7\n", 31), "cat PART"},
      {"1600000000.0 7 8 1 33\n1600000000.1 8 9 0 44\n", "sed '1i t x y p other' FILE"},
      {"0 12000 1600000000.0 7 8 1\n1 13000 1600000000.1 8 9 0\n", "is a table of 6 columns without names"}};
  for (const auto& [contents, remedy] : cases)
    EXPECT_THAT(Import(folder_.Write("a.raw", contents) + " --out " + log_, 1), HasSubstr(remedy));
}

TEST_F(ImportCommandTest, AFolderThatIsNotThereIsNamedBeforeAnythingIsRead) {
  const std::string events = folder_.Write("e.txt", "0.1 1 1 1\n0.2 2 2 0\n");
  EXPECT_THAT(Import(events + " --out " + folder_.File("none/a.lcmlog"), 1), HasSubstr("mkdir -p"));
  EXPECT_THAT(Import(events + " --out " + folder_.File(""), 1), HasSubstr("recording.lcmlog"));
}

TEST_F(ImportCommandTest, TextsOfSeveralKindsAndEurocsFolders) {
  std::string size = "346 260\n", index = ",timestamp,x,y,polarity\n", words = "timestamp,x,y,polarity\n";
  std::string imu =
      "#timestamp [ns],w_x [rad s^-1],w_y [rad s^-1],w_z [rad s^-1],a_x [m s^-2],a_y [m s^-2],a_z\n";
  for (int k = 0; k < 50; ++k) {
    const std::string t = std::to_string(1'600'000'000'000'000 + 1000L * k), x = std::to_string(3 * k);
    size += "1600000000." + std::to_string(1'000'000 + 1000 * k).substr(1) + " " + x + " 7 1\n";
    index.append(std::to_string(k)).append(",").append(t).append(",").append(x).append(",7,1\n");
    words.append(t).append(",").append(x).append(",7,True\n");
    imu.append(t).append("000,0.1,0.2,0.3,0.1,0.2,9.8\n");
  }
  std::filesystem::create_directories(folder_.File("mav0/imu0"));
  folder_.Write("mav0/imu0/data.csv", imu);
  for (const std::string& text : {size, index, words}) {
    const std::string path = folder_.Write("events.txt", text);
    EXPECT_THAT(Import(path + " --imu " + folder_.File("mav0") + " --out " + log_, 0), HasSubstr("50 events"))
        << text.substr(0, 100);
  }
}

TEST_F(ImportCommandTest, ACalibrationOfAnotherCameraLeavesNothingBehind) {
  const std::string path = M3edFile(folder_), rig_path = folder_.File("rig.textproto");
  EXPECT_THAT(
      Import(path + " --size 640x480 --calibration " + path + " --rig-out " + rig_path + " --out " + log_, 1),
      HasSubstr("is of a camera of 1280x720"));
  EXPECT_FALSE(std::filesystem::exists(log_));
  EXPECT_FALSE(std::filesystem::exists(rig_path));
}

// What is read, under whatever name or link, is never what is written; nor is another kind of file.
TEST_F(ImportCommandTest, NoInputIsOverwritten) {
  const std::string events = folder_.File("events.txt"), imu = folder_.File("imu.txt"),
                    link = folder_.File("link"), truth = log_ + ".truth.tum";
  const auto write = [](const std::string& path, const char* text) { std::ofstream(path) << text; };
  write(events, "0.001 1 2 1\n0.002 3 4 0\n");
  write(imu, "0 0 0 9.81 0 0 0\n0.003 0 0 9.81 0 0 0\n");
  write(truth, "0 0 0 0 0 0 0 1\n0.003 0 0 0 0 0 0 1\n");
  std::filesystem::create_symlink(events, link);
  const auto size = [&] { return std::filesystem::file_size(events) + std::filesystem::file_size(imu); };
  const auto before = size();
  EXPECT_THAT(Import(events + " --out " + events, 1), HasSubstr("is an input, which would be lost"));
  EXPECT_THAT(Import(events + " --out " + link, 1), HasSubstr(link + ": is " + events));
  EXPECT_THAT(Import(events + " --imu " + imu + " --out " + imu, 1), HasSubstr("which would be lost"));
  EXPECT_THAT(Import(events + " --truth " + truth + " --out " + log_, 1), HasSubstr("which would be lost"));
  EXPECT_THAT(Import(events + " --out " + imu, 1), HasSubstr("exists and is not a log"));
  EXPECT_EQ(size(), before);
  Import(events + " --out " + log_, 0);
  Import(events + " --out " + log_, 0);  // a log may be made again
  EXPECT_THAT(test::RunEvit("export evt3 " + log_ + " --out " + log_).output, HasSubstr("is an input"));
}

TEST_F(ImportCommandTest, OptionsWithoutEffectAreRefused) {
  const std::string events = folder_.File("events.txt");
  std::ofstream(events) << "0.001 1 2 1\n0.002 3 4 0\n";
  EXPECT_THAT(Import(events + " --truth none --truth-topic /pose --out " + log_, 1),
              HasSubstr("nothing is taken; leave the option out"));
  EXPECT_THAT(Import(events + " --imu-offset 0.1 --out " + log_, 1), HasSubstr("there is no IMU"));
  EXPECT_THAT(Import(events + " --imu-topic /imu --out " + log_, 1), HasSubstr("has no topics"));
  EXPECT_THAT(Import(events + " --events-topic left --out " + log_, 1), HasSubstr("leave the option out"));
}

TEST_F(ImportCommandTest, APipeIsNoOutput) {
  const std::string events = folder_.File("events.txt"), pipe = folder_.File("pipe");
  std::ofstream(events) << "0.001 1 2 1\n0.002 3 4 0\n";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(Import(events + " --out " + pipe, 1), HasSubstr("is a device or a pipe"));
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

}  // namespace
}  // namespace evit::commands
