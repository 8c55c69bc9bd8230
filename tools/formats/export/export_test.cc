#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "tests/helpers/imported_log.h"
#include "tests/helpers/temporary_folder.h"
#include "tools/formats/export/export_log.h"
#include "tools/formats/export/export_results.h"
#include "tools/formats/import/stream_writer.h"
#include "tools/formats/recognition/import_recording.h"
#include "tools/formats/tables/stream_tables.h"

namespace evit::formats {
namespace {

constexpr Utime kStart = 1'600'000'000'000'000;

class ExportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::mt19937 rng(3);
    for (Utime t = kStart; t < kStart + 300'000; t += rng() % 9)
      made_.events.push_back(t, rng() % 346, rng() % 260, rng() % 2);
    made_.events.push_back(kStart + 300'000, 345, 259, 1);
    for (int k = 0; k < 60; ++k)
      made_.imu.push_back({kStart + 5000 * k, {k / 8.0, 0.1, -2e-5}, {9.81, 1.0 / 3, -0.01 * k}});
    for (int k = 0; k < 30; ++k)
      made_.truth.push_back(
          {kStart + 10'000 * k, {Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5), {0.125 * k, 1, -0.25}}});
    StreamWriter writer(log_, kStart, made_.imu, made_.truth);
    for (std::size_t k = 0; k < made_.events.size(); ++k)
      writer.AddEvent(made_.events.t[k], made_.events.x[k], made_.events.y[k], made_.events.p[k]);
    writer.Close(kStart + 300'000);
  }
  // Exported, imported again with the files beside it.
  ImportedLog RoundTrip(ExportFormat format, const std::string& name, bool folder) {
    LogExport job;
    job.log = log_;
    job.out = folder_.File(name);
    job.format = format;
    const ExportSummary summary = ExportLog(job, [](double) {});
    EXPECT_EQ(summary.n_events, static_cast<std::int64_t>(made_.events.size()));
    RecordingImport again;
    again.any_imu = true;  // made-up numbers
    again.paths = {job.out};
    again.out = folder_.File("again.lcmlog");
    if (!folder) {
      again.imu = job.out + ".imu.txt";
      again.truth = job.out + ".groundtruth.txt";
    }
    ImportRecording(
        again, [](const RecordingInfo&, SE3*) {}, [](double) {});
    return ReadImported(again.out);
  }
  void ExpectMade(const ImportedLog& log) const {
    ExpectSame(log.events, made_.events);
    ExpectSame(log.imu, made_.imu);
    ExpectSame(log.truth, made_.truth);
  }

  const TemporaryFolder folder_{"export"};
  const std::string log_ = folder_.File("in.lcmlog");
  ImportedLog made_;
};

TEST_F(ExportTest, RpgsTextRoundTrips) { ExpectMade(RoundTrip(ExportFormat::kRpg, "rpg", true)); }

TEST_F(ExportTest, OfALogThatWasCutOffTheCompleteMessagesAreWrittenOnlyWhereAskedFor) {
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) / 2);
  LogExport job;
  job.log = log_;
  job.out = folder_.File("rpg");
  EXPECT_THAT([&] { ExportLog(job, [](double) {}); },
              ::testing::ThrowsMessage<std::runtime_error>(::testing::HasSubstr("--allow-truncated")));
  EXPECT_FALSE(std::filesystem::exists(job.out));
  job.allow_truncated = true;
  EXPECT_GT(ExportLog(job, [](double) {}).n_events, 0);
}

TEST_F(ExportTest, DsecsHdf5RoundTrips) { ExpectMade(RoundTrip(ExportFormat::kDsec, "events.h5", false)); }

TEST_F(ExportTest, Evt3RoundTripsFromItsFirstEventOn) {
  const ImportedLog log = RoundTrip(ExportFormat::kEvt3, "events.raw", false);
  for (Utime& t : made_.events.t) t -= kStart;
  for (ImuSample& s : made_.imu) s.t -= kStart;
  for (StampedPose& s : made_.truth) s.t -= kStart;
  ExpectMade(log);
}

TEST_F(ExportTest, TrajectoriesReadBackFromEveryFormat) {
  for (const auto& [format, name] :
       {std::pair(TrajectoryFormat::kTum, "a.tum"), std::pair(TrajectoryFormat::kEuroc, "a.csv")}) {
    WriteTrajectory(folder_.File(name), format, made_.truth);
    DropCounts dropped;
    ExpectSame(ReadPoseTable(folder_.File(name), &dropped), made_.truth);
  }
  WriteTrajectory(folder_.File("a.mcap"), TrajectoryFormat::kMcap, made_.truth);
  ExpectSame(OpenRecording({folder_.File("a.mcap")})->Streams().truth, made_.truth);
  WriteTrajectory(folder_.File("a.kitti"), TrajectoryFormat::kKitti,
                  {made_.truth.begin(), made_.truth.begin() + 2});
  std::ifstream kitti(folder_.File("a.kitti"));
  std::string first, second, third;
  std::getline(kitti, first);
  std::getline(kitti, second);
  EXPECT_EQ(second, "0 0 1 0.125 1 0 0 1 0 1 0 -0.25");
  EXPECT_FALSE(std::getline(kitti, third));
}

TEST(CameraTrajectoryTest, HoldsPosesAndStampsOfTheCamera) {
  Rig rig;
  rig.T_body_camera = {Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.1, 0, 0}};
  rig.camera_time_offset = 8376;  // us, from the camera's clock to the IMU's
  const SE3 turned(Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ())), {1, 2, 3});
  const Trajectory camera = CameraTrajectory({{kStart, turned}}, rig);
  ASSERT_EQ(camera.size(), 1U);
  EXPECT_EQ(camera[0].t, kStart - 8376);
  EXPECT_TRUE(camera[0].pose.p.isApprox(Eigen::Vector3d(1, 2.1, 3)));
  EXPECT_TRUE(camera[0].pose.R().isApprox(turned.R() * rig.T_body_camera.R()));
}

}  // namespace
}  // namespace evit::formats
