#include "tools/formats/recognition/recording_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/helpers/h5_files.h"
#include "tests/helpers/temporary_folder.h"
#include "tools/formats/recognition/import_recording.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

std::string Repeated(const std::string& rest) {
  std::string text;
  for (int k = 0; k < 30; ++k) text += "16000000" + std::to_string(10 + k) + ".5 " + rest + "\n";
  return text;
}

const std::string kEvents = Repeated("12 34 1"), kImu = Repeated("0.1 0.2 0.3 0.1 0.2 9.8"),
                  kPoses = Repeated("1 2 3 0 0 0 1");

void MakeH5(const std::string& path) {
  H5Maker file(path);
  for (const char* name : {"events/x", "events/y", "events/p"})
    file.Put(name, H5T_STD_U8LE, std::vector<std::int64_t>{1, 0, 1});
  file.Put("events/t", H5T_STD_I64LE, std::vector<std::int64_t>{1, 2, 3});
}

class RecordingFilesTest : public ::testing::Test {
 protected:
  RecordingFilesTest() { std::filesystem::create_directories(folder_.File("in")); }
  std::string Write(const std::string& name, const std::string& text) const {
    return folder_.Write("in/" + name, text);
  }
  template <typename Find>
  static void ExpectError(const Find& find, const std::string& a, const std::string& b) {
    EXPECT_THAT(find, ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(a), HasSubstr(b))));
  }

  const TemporaryFolder folder_{"recording_files"};
};

TEST_F(RecordingFilesTest, ListedFilesAreToldByTheirContents) {
  const std::string h5 = folder_.File("in/e.h5");
  MakeH5(h5);
  const std::string imu = Write("a.csv", kImu), poses = Write("b.csv", kPoses);
  for (const std::string& events : {h5, Write("c.csv", kEvents)}) {
    const RecordingFiles files = SortRecording({imu, events, poses});
    EXPECT_EQ(files.events, std::vector<std::string>{events});
    EXPECT_EQ(files.imu, imu);
    EXPECT_EQ(files.truth, poses);
  }
  ExpectError([&] { SortRecording({h5, imu, Write("second.txt", kImu)}); }, "second.txt", "--imu");
  EXPECT_EQ(SortRecording({h5, imu, Write("second.txt", kImu)}, imu).imu, imu);
  ExpectError([&] { SortRecording({h5, Write("c.csv", kEvents)}); }, "c.csv", "different recordings");
  ExpectError([&] { SortRecording({imu, poses}); }, "a.csv", "none of these holds events");
  ExpectError([&] { SortRecording({h5, Write("readme.md", "words")}); }, "readme.md", "neither");
  ExpectError([&] { SortRecording({h5, folder_.File("in/none.csv")}); }, "none.csv", "no such");
}

TEST_F(RecordingFilesTest, OfAFolderTextIsTakenByNameOrContents) {
  Write("recording.txt", kEvents);
  Write("sensor.csv", kImu);
  Write("estimate.tum", kPoses);  // not by its name the truth
  Write("notes.txt", "hello");
  const RecordingFiles files = FindRecording(folder_.File("in"));
  EXPECT_EQ(files.events, std::vector<std::string>{folder_.File("in/recording.txt")});
  EXPECT_EQ(files.imu, folder_.File("in/sensor.csv"));
  EXPECT_THAT(files.truth, IsEmpty());
  Write("groundtruth.txt", kPoses);
  EXPECT_EQ(FindRecording(folder_.File("in")).truth, folder_.File("in/groundtruth.txt"));
}

TEST_F(RecordingFilesTest, NamesMayBeInAnyCaseAndInFolders) {
  std::filesystem::create_directories(folder_.File("in/IMU0"));
  std::filesystem::create_directories(folder_.File("in/state_GroundTruth0"));
  const std::string events = Write("Events.TXT", kEvents), imu = Write("IMU0/data.CSV", kImu),
                    truth = Write("state_GroundTruth0/data.csv", kPoses);
  const RecordingFiles files = FindRecording(folder_.File("in"));
  EXPECT_EQ(files.events, std::vector<std::string>{events});
  EXPECT_EQ(files.imu, imu);
  EXPECT_EQ(files.truth, truth);
}

TEST_F(RecordingFilesTest, APackedRecordingInAFolderIsNamedWithItsRemedy) {
  Write("events.txt.gz", "\x1f\x8b\b....");
  ExpectError([&] { FindRecording(folder_.File("in")); }, "events.txt.gz", "gunzip");
}

TEST_F(RecordingFilesTest, AFolderOfSeveralRecordingsIsRefused) {
  MakeH5(folder_.File("in/a.h5"));
  Write("b.raw", std::string("% evt 3.0\n") + std::string(4, '\0'));
  ExpectError([&] { FindRecording(folder_.File("in")); }, "a.h5", "b.raw");
  std::filesystem::remove(folder_.File("in/a.h5"));
  EXPECT_EQ(FindRecording(folder_.File("in")).events, std::vector<std::string>{folder_.File("in/b.raw")});
}

TEST_F(RecordingFilesTest, TruthOfAnotherTimeIsRefusedAndCanBeLeftOut) {
  RecordingImport job;
  job.paths = {Write("e.txt", kEvents), Write("p.txt", "5.0 1 2 3 0 0 0 1\n6.0 1 2 3 0 0 0 1\n")};
  job.out = folder_.File("out.lcmlog");
  const auto import = [&] {
    return ImportRecording(
        job, [](const RecordingInfo&, SE3*) {}, [](double) {});
  };
  ExpectError(import, "p.txt", "--truth none");
  EXPECT_FALSE(std::filesystem::exists(job.out));
  job.truth = "none";
  EXPECT_EQ(import().n_truth, 0);
}

}  // namespace
}  // namespace evit::formats
