#include "tools/formats/recognition/import_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/helpers/h5_files.h"
#include "tests/helpers/imported_log.h"
#include "tests/helpers/ros2_bags.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class ImportRecordingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_.File("in"));
    job_.out = folder_.File("out.lcmlog");
  }
  ImportSummary Import() {
    return ImportRecording(
        job_, [&](const RecordingInfo& info, SE3*) { info_ = info; }, [](double) {});
  }

  const TemporaryFolder folder_{"import_recording"};
  RecordingImport job_;
  RecordingInfo info_;
};

// As TUM-VIE publishes it: events without offset, tables of IMU and truth in microseconds.
TEST_F(ImportRecordingTest, AFolderOfADataSetIsOneRecording) {
  {
    H5Maker left(folder_.File("in/loop-events_left.h5")), right(folder_.File("in/loop-events_right.h5"));
    for (H5Maker* file : {&left, &right}) {
      file->Put("events/x", H5T_STD_U16LE, std::vector<std::int64_t>{1, 1279, 3});
      file->Put("events/y", H5T_STD_U16LE, std::vector<std::int64_t>{4, 719, 6});
      file->Put("events/p", H5T_STD_U8LE, std::vector<std::int64_t>{0, 1, 0});
      file->Put("events/t", H5T_STD_I64LE, std::vector<std::int64_t>{1'000'000, 1'004'000, 1'009'000});
    }
  }
  folder_.Write("in/imu_data.txt",
                "# timestamp(us) gx gy gz ax ay az temperature\n1000000 1 2 3 0 0 9.81 40\n1005000 1 2 3 0 0 "
                "9.81 40\n1010000 1 2 3 0 0 9.81 40\n");
  folder_.Write("in/mocap_data.txt",
                "# timestamp(us) px py pz qx qy qz qw\n1000000 1 2 3 0 0 0 1\n1008000 1 2 3 0 0 0 1\n");
  job_.paths = {folder_.File("in")};
  job_.imu_offset = -0.001;
  job_.T_map_world = {Eigen::Quaterniond::Identity(), {10, 0, 0}};
  const ImportSummary summary = Import();
  EXPECT_EQ(info_.width, 1280);
  EXPECT_EQ(info_.height, 720);
  EXPECT_EQ(summary.n_events, 3);
  EXPECT_NEAR(summary.imu_rate_hz, 200, 1e-9);
  const ImportedLog log = ReadImported(job_.out);
  EXPECT_EQ(log.events.t, (std::vector<Utime>{1'000'000, 1'004'000, 1'009'000}));
  ASSERT_EQ(log.imu.size(), 3U);
  EXPECT_EQ(log.imu[1].t, 1'004'000);
  EXPECT_EQ(log.imu[1].gyro, Eigen::Vector3d(1, 2, 3));
  ASSERT_EQ(log.truth.size(), 2U);
  EXPECT_EQ(log.truth[0].pose.p, Eigen::Vector3d(11, 2, 3));

  // Of several the user's choice counts, and a truth of the IMU is not the IMU's samples.
  folder_.Write("in/other_imu.txt", "");
  EXPECT_THROW(Import(), std::runtime_error);
  job_.imu = folder_.File("in/imu_data.txt");
  folder_.Write("in/truth_imu.tum", "");
  EXPECT_THROW(Import(), std::runtime_error);
  job_.truth = folder_.File("in/mocap_data.txt");
  EXPECT_EQ(Import().n_events, 3);
}

TEST_F(ImportRecordingTest, EventsAloneBecomeALogWithoutImu) {
  job_.paths = {folder_.Write("in/some.txt", "# t x y p\n0.000001 3 4 1\n0.5 5 6 0\n")};
  const ImportSummary summary = Import();
  EXPECT_EQ(summary.n_events, 2);
  EXPECT_EQ(summary.n_imu, 0);
  const ImportedLog log = ReadImported(job_.out);
  EXPECT_EQ(log.events.t, (std::vector<Utime>{1, 500'000}));
  EXPECT_TRUE(log.imu.empty());
}

TEST_F(ImportRecordingTest, AnImuFileWithoutAnImuIsRefused) {
  job_.paths = {folder_.Write("in/some.txt", "0.000001 3 4 1\n0.5 5 6 0\n")};
  job_.imu = job_.paths.front();
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("is no IMU file")));
  EXPECT_FALSE(std::filesystem::exists(job_.out));
  job_.paths = {folder_.File("in")};
  job_.imu.clear();
  folder_.Write("in/events.txt", "0.1 1 1 1\n");
  folder_.Write("in/imu.txt", "0 0 0 9.81 1 2 3\n");
  folder_.Write("in/imu2.txt", "0 0 0 9.81 1 2 3\n");
  EXPECT_THAT([&] { Import(); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("--imu"), HasSubstr("imu2.txt"))));
}

// A bag with two IMUs and two truths: what another file gives is no question, what it gives itself is.
TEST_F(ImportRecordingTest, OfSeveralStreamsOnlyThoseTakenAreChosen) {
  const std::vector<double> covariance(9, 0);
  const auto imu = [&](Utime t, double x) {
    return ros2::Cdr()
        .Header(t)
        .Doubles({0, 0, 0, 1})
        .Doubles(covariance)
        .Doubles({x, 0, 0})
        .Doubles(covariance)
        .Doubles({0, 0, 9.81})
        .Doubles(covariance)
        .bytes();
  };
  std::vector<ros2::Message> messages;
  for (Utime t = 1'000'000; t <= 1'100'000; t += 10'000) {
    ros2::Cdr events;
    events.Header(t).Put(std::uint32_t{260}).Put(std::uint32_t{346}).Put(std::uint32_t{1});
    events.Put(std::uint16_t{3}).Put(std::uint16_t{4}).Time(t).Put(std::uint8_t{1});
    messages.push_back({"/cam/array", events.bytes(), t});
    messages.push_back({"/imu", imu(t, 1), t});
    messages.push_back({"/imu2", imu(t, 2), t});
    for (const char* topic : {"/odom", "/odom2"})
      messages.push_back({topic,
                          ros2::Cdr()
                              .Header(t)
                              .Text("body")
                              .Doubles({1, 2, 3, 0, 0, 0, 1})
                              .Doubles(std::vector<double>(36, 0))
                              .bytes(),
                          t});
  }
  const std::string bag = folder_.File("in/two.db3");
  ros2::WriteSqlite(bag, messages);
  job_.paths = {bag};
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("--imu-topic")));
  job_.choice.imu = "/imu2";
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("--truth-topic")));
  job_.truth = folder_.Write("in/truth.tum", "1.0 0 0 0 0 0 0 1\n1.1 0 0 0 0 0 0 1\n");
  EXPECT_EQ(Import().n_imu, 11);
  job_.choice.imu = "";
  job_.imu = folder_.Write("in/imu.csv",
                           "t,gx,gy,gz,ax,ay,az\n1.00,0,0,0,0,0,9.81\n1.05,0,0,0,0,0,9.81\n"
                           "1.10,0,0,0,0,0,9.81\n");
  EXPECT_EQ(Import().n_imu, 3);

  // As the file of one stream it is asked for that alone.
  job_.paths = {folder_.Write("in/some.txt", "# t x y p\n1.0 3 4 1\n1.1 5 6 0\n")};
  job_.imu = bag;
  job_.choice.imu = "/imu";
  EXPECT_EQ(Import().n_imu, 11);
  job_.imu.clear(), job_.choice.imu.clear();
  job_.truth = bag;
  job_.choice.truth = "/odom";
  Import();
  EXPECT_EQ(ReadImported(job_.out).truth.size(), 11U);
  job_.choice.truth.clear();
  EXPECT_THAT([&] { Import(); }, ThrowsMessage<std::runtime_error>(HasSubstr("--truth-topic")));
}

}  // namespace
}  // namespace evit::formats
