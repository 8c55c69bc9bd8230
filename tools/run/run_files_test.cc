#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "common/bus/log_file.h"
#include "common/config/rig_file.h"
#include "common/map/map_file.h"
#include "tests/helpers/paths.h"
#include "tests/helpers/sample_messages.h"
#include "tools/run/run_inputs.h"

namespace evit::run {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr Utime kStart = 1'642'661'138'000'000;

// A second of a log (IMU every 10 ms, 30 events every 10 ms), its truth, and a map of a wall.
class RunFilesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) / ("run_files_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    job_.log = Path("a.lcmlog");
    job_.map = Path("map.pcd");
    job_.rig = test::SourcePath("config/vector/rig.textproto");
    job_.config = test::SourcePath("config/tracker.textproto");
    job_.out = Path("out");
    job_.tolerate.any_imu = true;  // made-up numbers
    job_.truth = job_.initial_from = Path("truth.tum");
    WriteLog(0);
    Trajectory truth;
    for (int k = 0; k <= 100; ++k) truth.push_back({kStart + Utime{10'000} * k, At(k)});
    WriteTum(job_.truth, truth);
    PointMap map;
    for (int row = 0; row < 20; ++row) {
      for (int k = 0; k < 20; ++k) map.points.emplace_back(0.1 * k, 0.1 * row, 2);
    }
    WritePcd(job_.map, map);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static SE3 At(int k) { return {Eigen::Quaterniond::Identity(), {0.01 * k, 0, 1}}; }
  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  /// `shift`: of the log's own clock against the sensor's, us, as in lcm-logger's logs.
  void WriteLog(Utime shift, const std::function<void(imu_batch_t*)>& change = nullptr,
                const std::string& other_imu = "") const {
    LogWriter log(job_.log);
    std::vector<std::uint8_t> bytes;
    for (int k = 0; k <= 100; ++k) {
      auto imu = Sample<imu_batch_t>(1);
      imu.seq = k;
      imu.utime = imu.sample_utime[0] = kStart + Utime{10'000} * k;
      const Utime stamp = imu.utime;
      if (!other_imu.empty()) {
        auto other = imu;
        other.utime = other.sample_utime[0] = stamp - 77'000'000;
        EncodeTo(other, &bytes);
        log.Write(stamp + shift, other_imu, bytes.data(), bytes.size());
      }
      if (change) change(&imu);
      EncodeTo(imu, &bytes);
      log.Write(stamp + shift, "IMU", bytes.data(), bytes.size());
      auto events = Sample<event_packet_t>(30);
      events.seq = k;
      events.utime = stamp;
      EncodeTo(events, &bytes);
      log.Write(stamp + shift, "EVENTS", bytes.data(), bytes.size());
    }
    log.Close();
  }
  void ExpectRefused(const ::testing::Matcher<std::string>& message) const {
    EXPECT_THAT([&] { PrepareRun(job_); }, ThrowsMessage<std::runtime_error>(message));
    EXPECT_FALSE(std::filesystem::exists(job_.out));  // nothing half-written
  }

  std::filesystem::path folder_;
  RunJob job_;
};

TEST_F(RunFilesTest, SpanEventsStartAndTruth) {
  const RunInputs inputs = PrepareRun(job_);
  EXPECT_EQ(inputs.begin, kStart);
  EXPECT_EQ(inputs.end, kStart + 1'000'000);
  EXPECT_EQ(inputs.n_events, 101 * 30);
  EXPECT_EQ(inputs.truth.size(), 101U);
  EXPECT_TRUE(inputs.start->p.isApprox(At(0).p));
  EXPECT_TRUE(std::filesystem::is_directory(job_.out));
}

TEST_F(RunFilesTest, PartOfTheLogBeginsWhereTheTruthIsThen) {
  job_.play.seconds = {0.2, 0.6};
  const RunInputs inputs = PrepareRun(job_);
  EXPECT_EQ(inputs.begin, kStart + 200'000);
  EXPECT_EQ(inputs.end, kStart + 600'000);
  EXPECT_EQ(inputs.n_events, 41 * 30);
  EXPECT_EQ(inputs.truth.size(), 41U);
  EXPECT_TRUE(inputs.start->p.isApprox(At(20).p));
}

TEST_F(RunFilesTest, LogsStampedByTheHostCountInSensorTime) {
  WriteLog(50'000'000'000);
  const RunInputs inputs = PrepareRun(job_);
  EXPECT_EQ(inputs.begin, kStart);
  EXPECT_EQ(inputs.end, kStart + 1'000'000);
  EXPECT_EQ(inputs.n_events, 101 * 30);
}

// Another sensor's channel ends like ours.
TEST_F(RunFilesTest, ChannelsThatOnlyEndLikeOursAreLeftAlone) {
  WriteLog(0, nullptr, "XSENS_IMU");
  const RunInputs inputs = PrepareRun(job_);
  EXPECT_EQ(inputs.begin, kStart);
  EXPECT_EQ(inputs.end, kStart + 1'000'000);
  EXPECT_EQ(inputs.log_prefix, "");
}

TEST_F(RunFilesTest, TwoClocksAreToldFromTheStamps) {
  WriteLog(0, [](imu_batch_t* m) { m->utime = m->sample_utime[0] = m->utime - kStart; });
  ExpectRefused(AllOf(HasSubstr("a.lcmlog"), HasSubstr("two clocks")));
}

TEST_F(RunFilesTest, AnImuThatCannotBeIsToldAtTheStart) {
  job_.tolerate.any_imu = false;
  const auto reads = [&](double z) {
    WriteLog(0, [z](imu_batch_t* m) {
      m->gyro[0] = {0, 0, 0};
      m->accel[0] = {0, 0, z};
    });
  };
  reads(9.81);
  EXPECT_NO_THROW(PrepareRun(job_));
  std::filesystem::remove_all(job_.out);
  reads(1);
  ExpectRefused(AllOf(HasSubstr("in g"), HasSubstr("--accel-unit")));
  reads(0.01);
  ExpectRefused(HasSubstr("taken off"));
  reads(-9.81);
  ExpectRefused(HasSubstr("sign turned"));
}

// Kalibr's T_cam_imu pasted as T_body_camera: the map lies on the sample's events with the inverse only.
TEST_F(RunFilesTest, ExtrinsicsThatWereNotInvertedAreNoticed) {
  job_.log = test::SourcePath("logs/sample.lcmlog");
  job_.map = test::SourcePath("logs/sample_map.pcd");
  job_.rig = test::SourcePath("logs/rig.textproto");
  job_.truth = job_.initial_from = test::SourcePath("logs/sample_truth.tum");
  job_.tolerate.any_imu = false;
  EXPECT_NO_THROW(PrepareRun(job_));
  std::filesystem::remove_all(job_.out);
  Rig rig = LoadRig(job_.rig);
  rig.T_body_camera = rig.T_body_camera.Inverse();
  job_.rig = Path("rig.textproto");
  WriteRig(job_.rig, rig, "not inverted", "");
  ExpectRefused(AllOf(HasSubstr("rig.textproto"), HasSubstr("looks like its inverse")));
}

TEST_F(RunFilesTest, ARigOfASmallerImageIsRefused) {
  job_.log = test::SourcePath("logs/sample.lcmlog");
  job_.map = test::SourcePath("logs/sample_map.pcd");
  job_.truth = job_.initial_from = test::SourcePath("logs/sample_truth.tum");
  Rig rig = LoadRig(test::SourcePath("logs/rig.textproto"));
  job_.rig = Path("rig.textproto");
  rig.camera.width = 319;  // a column of 320 is few
  WriteRig(job_.rig, rig, "nearly", "");
  EXPECT_NO_THROW(PrepareRun(job_));
  std::filesystem::remove_all(job_.out);
  rig.camera.width = 160, rig.camera.height = 120;
  WriteRig(job_.rig, rig, "half", "");
  ExpectRefused(AllOf(HasSubstr("rig.textproto (width: 160, height: 120)"), HasSubstr("largest x is 319"),
                      HasSubstr("largest y 239")));
}

TEST_F(RunFilesTest, SlowTruthGivesTheStartAndTheScore) {
  Trajectory truth;
  for (int k = 0; k <= 100; k += 25) truth.push_back({kStart - 100'000 + Utime{10'000} * k, At(k)});
  WriteTum(job_.truth, truth);
  const RunInputs inputs = PrepareRun(job_);
  ASSERT_TRUE(inputs.start.has_value());
  EXPECT_NEAR(inputs.start->p.x(), 0.1, 1e-6);
  EXPECT_EQ(inputs.truth.size(), 4U);
}

TEST_F(RunFilesTest, GivenPoseNeedsNoTruth) {
  job_.initial_pose = At(7);
  job_.initial_from = job_.truth = "";
  const RunInputs inputs = PrepareRun(job_);
  EXPECT_TRUE(inputs.start->p.isApprox(At(7).p));
  EXPECT_TRUE(inputs.truth.empty());
}

TEST_F(RunFilesTest, OldResultsAreRemoved) {
  std::filesystem::create_directories(job_.out);
  std::ofstream(job_.out + "/trajectory.tum") << "old";
  std::ofstream(job_.out + "/mine.txt") << "kept";
  PrepareRun(job_);
  EXPECT_FALSE(std::filesystem::exists(job_.out + "/trajectory.tum"));
  EXPECT_TRUE(std::filesystem::exists(job_.out + "/mine.txt"));
}

TEST_F(RunFilesTest, EachUnusableFileIsNamedBeforeAnythingIsWritten) {
  const RunJob good = job_;
  for (std::string RunJob::*file :
       {&RunJob::log, &RunJob::map, &RunJob::rig, &RunJob::config, &RunJob::initial_from, &RunJob::truth}) {
    job_ = good;
    job_.*file = Path("none");
    ExpectRefused(HasSubstr(Path("none")));
  }
  job_ = good;
  std::ofstream(job_.map) << "";
  ExpectRefused(HasSubstr("map.pcd"));
}

TEST_F(RunFilesTest, CutLogIsRefused) {
  std::filesystem::resize_file(job_.log, std::filesystem::file_size(job_.log) - 5);
  ExpectRefused(AllOf(HasSubstr("a.lcmlog"), HasSubstr("truncated")));
}

TEST_F(RunFilesTest, CutLogRunsAsFarAsItGoesWhereThatIsAskedFor) {
  std::filesystem::resize_file(job_.log, std::filesystem::file_size(job_.log) - 5);
  job_.tolerate.truncated = true;
  const RunInputs inputs = PrepareRun(job_);
  EXPECT_EQ(inputs.n_events, 100 * 30);
  EXPECT_GT(inputs.lost_bytes, 0);
}

TEST_F(RunFilesTest, TruthOfAnotherTimeIsRefused) {
  WriteTum(job_.truth, {{5'000'000, At(0)}, {6'000'000, At(1)}});
  ExpectRefused(HasSubstr("same sequence"));
}

TEST_F(RunFilesTest, UnwritableOutputIsNamed) {
  std::ofstream(Path("file")) << "";
  job_.out = Path("file") + "/out";
  EXPECT_THAT([&] { PrepareRun(job_); }, ThrowsMessage<std::runtime_error>(HasSubstr("file/out")));
}

}  // namespace
}  // namespace evit::run
