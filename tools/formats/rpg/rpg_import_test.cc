#include "tools/formats/rpg/rpg_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/config/rig_file.h"
#include "tests/helpers/rpg_folder.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST_F(RpgImportTest, StreamsRoundTrip) {
  const ImportSummary summary = Import();
  EXPECT_EQ(summary.n_events, static_cast<std::int64_t>(made_.events.size()));
  EXPECT_EQ(summary.n_imu, 500);
  EXPECT_EQ(summary.n_truth, 100);
  EXPECT_EQ(summary.dropped_events.total() + summary.dropped_imu.total() + summary.dropped_truth.total(), 0);
  const ImportedLog out = ReadImported(job_.out);
  ExpectSame(out.events, made_.events);
  ExpectSame(out.imu, made_.imu);
  ExpectSame(out.truth, made_.truth);
}

TEST_F(RpgImportTest, InvalidEntriesAreCountedAndDropped) {
  Append("events.txt", "0.1 1 1 1\nnan 1 1 0\n0.6 240 0 1\n0.6 0 180 1\n0.6 -1 0 1\n0.600000 239 179 1\n");
  Append("imu.txt", "0.499003 0 0 0 0 0 0\n0.5 0 0 nan 0 0 0\n0.51 0 0 9 0 0 inf\n");
  Append("groundtruth.txt", "0.5 0 0 0 0 0 0 0\n0.5 nan 0 0 0 0 0 1\n0.1 0 0 0 0 0 0 1\n");
  const ImportSummary summary = Import();
  EXPECT_EQ(summary.dropped_events.late, 1);
  EXPECT_EQ(summary.dropped_events.invalid, 1);
  EXPECT_EQ(summary.dropped_events.outside, 3);
  EXPECT_EQ(summary.dropped_imu.late, 1);
  EXPECT_EQ(summary.dropped_imu.invalid, 2);
  EXPECT_EQ(summary.dropped_truth.late, 1);
  EXPECT_EQ(summary.dropped_truth.invalid, 2);
  const ImportedLog out = ReadImported(job_.out);
  made_.events.push_back(600'000, 239, 179, 1);
  ExpectSame(out.events, made_.events);
  ExpectSame(out.imu, made_.imu);
  ExpectSame(out.truth, made_.truth);
}

TEST_F(RpgImportTest, OneStampInTheFutureCostsItselfOnly) {
  for (const char* name : {"events.txt", "imu.txt", "groundtruth.txt"}) {
    SetUp();
    std::stringstream all;
    all << std::ifstream(In(name)).rdbuf();
    std::string text = all.str();
    const std::size_t at = text.find('\n', text.size() / 3) + 1;  // a row begins
    text.replace(at, 1, "500");
    std::ofstream(In(name)) << text;
    const ImportSummary summary = Import();
    EXPECT_EQ(summary.dropped_events.outlier + summary.dropped_imu.outlier + summary.dropped_truth.outlier, 1)
        << name;
    EXPECT_EQ(summary.dropped_events.total() + summary.dropped_imu.total() + summary.dropped_truth.total(), 1)
        << name;
  }
}

TEST_F(RpgImportTest, AnImuInOtherUnitsIsRefusedOrConverted) {
  job_.any_imu = false;
  const auto write = [&](double scale) {
    std::ofstream imu(In("imu.txt"));
    for (int k = 0; k < 500; ++k) imu << 0.001 * k << " 0 0 " << 9.80665 * scale << " 0.01 0.02 0.03\n";
  };
  write(1 / 9.80665);
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(AllOf(
                                     HasSubstr("imu.txt"), HasSubstr("in g"), HasSubstr("--accel-unit"))));
  EXPECT_FALSE(std::filesystem::exists(job_.out));
  job_.accel_scale = 9.80665;
  Import();
  EXPECT_NEAR(ReadImported(job_.out).imu[7].accel.z(), 9.80665, 1e-4);
  job_.accel_scale = 1;
  job_.any_imu = true;
  Import();
}

TEST_F(RpgImportTest, RigIsWrittenFromTheCalibration) {
  job_.rig_out = (folder_ / "rig.textproto").string();
  job_.T_body_camera = {Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), {0.01, 0.02, 0.03}};
  job_.imu_noise.gyro_density = 0.0125;
  Import();
  const Rig rig = LoadRig(job_.rig_out);
  EXPECT_EQ(rig.camera.width, 240);
  EXPECT_EQ(rig.camera.height, 180);
  EXPECT_EQ(rig.camera.fx, 199.092366542);
  EXPECT_EQ(rig.camera.cy, 110.712660011);
  EXPECT_EQ(rig.camera.distortion, (std::array<double, 5>{-0.368436311798, 0.150947243557, -0.000296130534385,
                                                          -0.000759431726241, 0.0}));
  EXPECT_EQ(rig.imu_rate_hz, 1000);
  EXPECT_EQ(rig.imu_noise.gyro_density, 0.0125);
  EXPECT_EQ(rig.imu_noise.accel_density, kDavisImuNoise.accel_density);
  EXPECT_TRUE(rig.T_body_camera.p.isApprox(job_.T_body_camera.p));
  // The truth is the camera's; the log tells of the body.
  const ImportedLog out = ReadImported(job_.out);
  ASSERT_EQ(out.truth.size(), 100U);
  const SE3 camera = out.truth[7].pose * rig.T_body_camera;
  EXPECT_TRUE(camera.p.isApprox(made_.truth[7].pose.p, 1e-12));
  EXPECT_NEAR(AngularDistance(camera.q, made_.truth[7].pose.q), 0, 1e-12);
  job_.truth_of_body = true;
  Import();
  ExpectSame(ReadImported(job_.out).truth, made_.truth);
}

// A recorder that was switched off leaves half a row, or zeros that the file system had reserved.
TEST_F(RpgImportTest, AFileThatIsCutOffIsReadUpToItsLastRow) {
  for (const std::string& tail : {std::string("0.6 1 "), std::string(4096, '\0')}) {
    made_ = {};
    SetUp();
    Append("events.txt", tail);
    const ImportSummary summary = Import();
    EXPECT_EQ(summary.n_events, static_cast<std::int64_t>(made_.events.size()));
    EXPECT_TRUE(summary.dropped_events.cut_off);
  }
}

TEST_F(RpgImportTest, StampsOfAnotherUnitAreNoRecordingOfSilence) {
  std::ofstream(In("imu.txt")) << "t ax ay az gx gy gz\n0 0 0 9.81 0 0 0\n30000 0 0 9.81 0 0 0\n";
  {
    std::ofstream events(In("events.txt"));
    events << "t[s] x y p\n";
    for (int k = 0; k < 2000; ++k) events << 15 * k << " 1 1 " << k % 2 << '\n';
  }
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("the unit of the stamps")));
}

TEST_F(RpgImportTest, ErrorsNameFileLineAndRemedy) {
  Append("events.txt", "0.6 1 1\n");
  const std::string line = "events.txt:" + std::to_string(made_.events.size() + 1);
  EXPECT_THAT([&] { Import(); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(line), HasSubstr("t x y p"))));
  EXPECT_FALSE(std::filesystem::exists(job_.out));
  EXPECT_FALSE(std::filesystem::exists(job_.out + ".part"));
  std::ofstream(In("events.txt")) << "0.1 1 1 2\n";
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("polarity is 2")));
  std::ofstream(In("events.txt")) << "0.1 1 1 -1\n0.1 1 1 0\n";
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(
                                     AllOf(HasSubstr("events.txt:2"), HasSubstr("0 and -1 both occur"))));
  std::ofstream(In("events.txt")) << "0.1 1.25 1 1\n";
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("not a whole number")));
  std::ofstream(In("events.txt")) << "346 260\n0.1 1 1 1\n0.1 1 1 1\n";
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("--size 346x260")));
  std::ofstream(In("events.txt")) << "0.1 999 1 1\n";
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("is the image size right?")));
  {
    std::ofstream events(In("events.txt"));
    for (const char* second : {"0", "1468941032"}) {
      for (int k = 100; k < 300; ++k) events << second << '.' << k << " 1 1 1\n";
    }
  }
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("the time jumps")));
  job_.rig_out = (folder_ / "rig.textproto").string();
  job_.width = 100;
  EXPECT_THAT([&] { Import(); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("calib.txt:1"), HasSubstr("--size"))));
  std::filesystem::remove(In("calib.txt"));
  EXPECT_THAT([&] { Import(); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("calib.txt"), HasSubstr("no such file"))));
  job_.folder = "/no/such";
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("/no/such")));
}

TEST_F(RpgImportTest, StreamsOfTwoClocksAreRejected) {
  std::ofstream(In("imu.txt")) << "1468941032.0 0 0 0 0 0 0\n1468941032.1 0 0 0 0 0 0\n";
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(
                                     AllOf(HasSubstr("imu.txt"), HasSubstr("after the last event"))));
}

TEST_F(RpgImportTest, StampsThatWereRoundedAwayAreRefused) {
  {
    std::ofstream events(In("events.txt"));
    for (int k = 0; k < 2000; ++k) events << (k < 1000 ? "0.100000" : "0.200000") << " 1 1 " << k % 2 << '\n';
  }
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("only 2 different stamps")));
}

}  // namespace
}  // namespace evit::formats
