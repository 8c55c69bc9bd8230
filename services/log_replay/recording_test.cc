#include "services/log_replay/recording.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "services/log_replay/pacer.h"
#include "tests/helpers/replay_recording.h"

namespace evit {
namespace {

class RecordingTest : public ::testing::Test {
 protected:
  RecordingTest() : path_(::testing::TempDir() + "recording_test.lcmlog") {}
  ~RecordingTest() override { std::filesystem::remove(path_); }
  std::string OpenError(const std::string& prefix = "") const {
    try {
      const Recording recording(path_, prefix);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  std::string path_;
};

TEST_F(RecordingTest, HasTheStreamsInTheOrderOfTheLog) {
  WriteTestRecording(path_, {});
  const Recording recording(path_, "");
  ASSERT_EQ(recording.size(), 400U);
  EXPECT_EQ(recording.kind(0), Recording::kEvents);
  EXPECT_EQ(recording.kind(1), Recording::kGroundTruth);
  EXPECT_EQ(recording.kind(3), Recording::kImu);
  EXPECT_EQ(recording.begin_utime(), 5'000'000);
  EXPECT_EQ(recording.FirstAt(0), 0U);
  EXPECT_EQ(recording.FirstAt(5'010'000), 4U);
  EXPECT_EQ(recording.FirstAt(9'000'000), 400U);
}

TEST_F(RecordingTest, FindsThePrefixByItself) {
  TestRecording with_prefix;
  with_prefix.prefix = "left/";
  WriteTestRecording(path_, with_prefix);
  EXPECT_EQ(Recording(path_, "").size(), 400U);
  EXPECT_EQ(Recording(path_, "left/").size(), 400U);
  EXPECT_NE(OpenError("right/").find("--log-prefix"), std::string::npos);
}

TEST_F(RecordingTest, SaysWhatIsWrongWithALog) {
  EXPECT_NE(OpenError().find("cannot open"), std::string::npos);
  {
    LogWriter log(path_);
    log.Write(1, "IMU", "x", 1);
  }
  const std::string no_events = OpenError();
  EXPECT_NE(no_events.find("no channel EVENTS (it has: IMU)"), std::string::npos) << no_events;
  WriteTestRecording(path_, {});
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 1);
  EXPECT_NE(OpenError().find("cut off"), std::string::npos);
  EXPECT_EQ(Recording(path_, "", true).size(), 399U);
}

TEST(Pacer, MapsDataTimeToWallTime) {
  Pacer pacer(2.0);
  pacer.Start(1000, 50'000);
  EXPECT_EQ(pacer.Until(50'000, 1000), 0);
  EXPECT_EQ(pacer.Until(52'000, 1000), 1000);
  EXPECT_EQ(pacer.Until(52'000, 1500), 500);
  pacer.SetSpeed(0.5, 2000, 0);  // data time 52,000 is due now
  EXPECT_EQ(pacer.Until(52'000, 2000), 0);
  EXPECT_EQ(pacer.Until(53'000, 2000), 2000);
  pacer.SetSpeed(0, 2000, 0);
  EXPECT_EQ(pacer.Until(1'000'000'000, 2000), 0);
  pacer.SetSpeed(1, 3000, 60'000);  // from unpaced: continues where the data are
  EXPECT_EQ(pacer.Until(60'500, 3000), 500);
}

}  // namespace
}  // namespace evit
