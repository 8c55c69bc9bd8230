#include "tools/formats/rpg/rpg_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <random>
#include <sstream>

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
    job_.any_imu = true;  // made-up numbers
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

// What other programs write; each must give the same events.
TEST_F(RpgImportTest, EventsInEveryFormThatHasOneMeaning) {
  constexpr int kEvents = 4000;
  const auto write = [&](const std::string& head, const std::string& end,
                         const std::function<std::string(Utime, int, int, int)>& row) {
    std::ofstream out(In("events.txt"), std::ios::binary);
    out << head;
    for (int k = 0; k < kEvents; ++k)
      out << row(made_.events.t[k], made_.events.x[k], made_.events.y[k], made_.events.p[k]) << end;
  };
  const auto text = [](const char* format, auto... values) {
    char row[200];
    std::snprintf(row, sizeof row, format, values...);
    return std::string(row);
  };
  const auto seconds = [](Utime t) { return 1e-6 * static_cast<double>(t); };
  const std::vector<std::function<void()>> forms = {
      [&] {
        write("240 180\n", "\n",
              [&](Utime t, int x, int y, int p) { return text("%.6f %d %d %d", seconds(t), x, y, p); });
      },
      [&] {
        write("", "\n", [&](Utime t, int x, int y, int p) {
          return text("%.18e %.18e %.18e %.18e", seconds(t), 1.0 * x, 1.0 * y, 1.0 * p);
        });
      },
      [&] {
        write("\xEF\xBB\xBFt,x,y,p\r\n", "\r\n",
              [&](Utime t, int x, int y, int p) { return text("%.6f,%d.0,%d.0,%d", seconds(t), x, y, p); });
      },
      [&] {
        write("# t x y p\r", "\r", [&](Utime t, int x, int y, int p) {
          return text("%.6f;%d;%d;%s", seconds(t), x, y, p ? "True" : "False");
        });
      },
      [&] {
        write("", "\n", [&](Utime t, int x, int y, int p) {
          return text("%.6f %d %d %d", seconds(t), x, y, 2 * p - 1);
        });
      },
      [&] {
        write("", "\n", [&](Utime t, int x, int y, int p) {
          return text("%lld %d %d %d", static_cast<long long>(t), x, y, p);
        });
      },
      [&] {
        write("ts.secs,ts.nsecs,x,y,polarity\n", "\n", [&](Utime t, int x, int y, int p) {
          return text("%lld,%lld,%d,%d,%d", static_cast<long long>(t / 1'000'000),
                      static_cast<long long>(t % 1'000'000 * 1000), x, y, p);
        });
      },
      [&] {
        write("", "\n", [&](Utime t, int x, int y, int p) {
          return text("%d,%d,%d,%lld", x, y, p, static_cast<long long>(t));
        });
      },
      [&] {
        write(",x,y,polarity,timestamp\n", "\n", [&](Utime t, int x, int y, int p) {
          return text("7,%d,%d,%d,%lld", x, y, p, static_cast<long long>(t));
        });
      },
      [&] {
        write("", "\n",
              [&](Utime t, int x, int y, int p) { return text("%d %d %.6f %d", x, y, seconds(t), p); });
      },
      [&] {
        write("x y t[ns] p\n", "\n", [&](Utime t, int x, int y, int p) {
          return text("%d %d %lld %d", x, y, static_cast<long long>(1000 * t), p);
        });
      },
      [&] {
        write("", "\n",
              [&](Utime t, int x, int y, int p) { return text("%.3f %d %d %d", 1e3 * seconds(t), x, y, p); });
      },
      [&] {
        write("secs,nsecs,x,y,p\n", "\n", [&](Utime t, int x, int y, int p) {
          return text("%lld,%lld,%d,%d,%s", static_cast<long long>(t / 1'000'000),
                      static_cast<long long>(t % 1'000'000 * 1000), x, y, p ? "pos" : "neg");
        });
      },
      [&] {
        write("% recorded with\n% geometry 240x180\n", "\n", [&](Utime t, int x, int y, int p) {
          return text("%d %d %d %lld", p, x, y, static_cast<long long>(t));
        });
      },
      [&] {
        write("t (\xC2\xB5s),x,y,p\n", "\n", [&](Utime t, int x, int y, int p) {
          return text("%lld,%d,%d,%s", static_cast<long long>(t), x, y, p ? "+" : "-");
        });
      },
  };
  made_.events.t.resize(kEvents), made_.events.x.resize(kEvents), made_.events.y.resize(kEvents),
      made_.events.p.resize(kEvents);
  for (std::size_t k = 0; k < forms.size(); ++k) {
    SCOPED_TRACE(k);
    forms[k]();
    Import();
    ExpectSame(ReadImported(job_.out).events, made_.events);
  }
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
