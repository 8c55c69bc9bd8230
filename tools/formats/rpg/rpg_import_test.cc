#include "tools/formats/rpg/rpg_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <random>

#include "common/config/rig_file.h"
#include "common/files/decimal_time.h"
#include "tests/helpers/imported_log.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Half a second from t = 0 on, as RPG's recordings begin there: events with 30 ms of silence, IMU at 1 kHz.
class RpgImportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(In(""));
    std::mt19937 rng(3);
    std::ofstream events(In("events.txt")), imu(In("imu.txt")), truth(In("groundtruth.txt"));
    for (Utime t = 0; t < 500'000; t += t == 200'000 ? 30'000 : rng() % 9) {
      made_.events.push_back(t, rng() % 240, rng() % 180, rng() % 2);
      events << DecimalSeconds(t) << "000 " << made_.events.x.back() << ' ' << made_.events.y.back() << ' '
             << int{made_.events.p.back()} << '\n';
    }
    for (int k = 0; k < 500; ++k) {
      const ImuSample s{Utime{1000} * k + 3, {k / 8.0, 0.1, -2e-5}, {9.81, 1.0 / 3, -0.0625 * k}};
      made_.imu.push_back(s);
      imu << DecimalSeconds(s.t) << std::setprecision(17);
      for (const auto& v : {s.accel, s.gyro}) imu << ' ' << v.x() << ' ' << v.y() << ' ' << v.z();
      imu << '\n';
    }
    for (int k = 0; k < 100; ++k) {
      const double h = k % 2 == 0 ? 0.5 : -0.5;  // exactly of length 1
      made_.truth.push_back({Utime{5000} * k, {Eigen::Quaterniond(0.5, h, 0.5, 0.5), {0.125 * k, 1, -0.3}}});
      truth << TumLine(made_.truth.back()) << '\n';
    }
    std::ofstream(In("calib.txt"))
        << "199.092366542 198.82882047 132.192071378 110.712660011 -0.368436311798 "
           "0.150947243557 -0.000296130534385 -0.000759431726241 0.0\n";
    job_.folder = In("");
    job_.out = (folder_ / "out.lcmlog").string();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string In(const std::string& name) const { return (folder_ / "in" / name).string(); }
  ImportSummary Import() const {
    return ImportRpg(job_, [](double) {});
  }
  void Append(const std::string& name, const std::string& text) const {
    std::ofstream(In(name), std::ios::app) << text;
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(::testing::TempDir()) / ("rpg_" + std::to_string(getpid()));
  ImportedLog made_;
  RpgImport job_;
};

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
  EXPECT_EQ(summary.dropped_events.disorder, 1);
  EXPECT_EQ(summary.dropped_events.invalid, 1);
  EXPECT_EQ(summary.dropped_events.outside, 3);
  EXPECT_EQ(summary.dropped_imu.disorder, 1);
  EXPECT_EQ(summary.dropped_imu.invalid, 2);
  EXPECT_EQ(summary.dropped_truth.disorder, 1);
  EXPECT_EQ(summary.dropped_truth.invalid, 2);
  const ImportedLog out = ReadImported(job_.out);
  made_.events.push_back(600'000, 239, 179, 1);
  ExpectSame(out.events, made_.events);
  ExpectSame(out.imu, made_.imu);
  ExpectSame(out.truth, made_.truth);
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

TEST_F(RpgImportTest, ErrorsNameFileLineAndRemedy) {
  Append("events.txt", "0.6 1 1\n");
  const std::string line = "events.txt:" + std::to_string(made_.events.size() + 1);
  EXPECT_THAT([&] { Import(); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(line), HasSubstr("t x y p"))));
  EXPECT_FALSE(std::filesystem::exists(job_.out));
  EXPECT_FALSE(std::filesystem::exists(job_.out + ".part"));
  std::ofstream(In("events.txt")) << "0.1 1 1 -1\n";
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("polarity is -1")));
  std::ofstream(In("events.txt")) << "0.1 999 1 1\n";
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("is the image size right?")));
  std::ofstream(In("events.txt")) << "0.1 1 1 1\n1468941032.5 1 1 1\n";
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

}  // namespace
}  // namespace evit::formats
