#include "tools/formats/recognition/open_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/helpers/ros_bags.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(OpenRecording, WhatIsNotRecognisedIsSaidWithWhatWouldBe) {
  const TemporaryFolder folder("recognition");
  const std::string path = folder.Write("a.raw",
                                        "\x7f"
                                        "ELF something else");
  EXPECT_THAT([&] { OpenRecording({path}); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(path), HasSubstr("Metavision RAW"))));
  EXPECT_THAT([&] { OpenRecording({folder.File("none")}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("there is no such file")));
}

TEST(MeasureSize, TheSmallestKnownSensorThatHoldsAllEventsIsTaken) {
  const TemporaryFolder folder("recognition");
  std::string words = "% evt 3.0\n";
  for (const unsigned word : {0x8001U, 0x6001U, 0x0000U | 250U, 0x2000U | 300U, 0x8001U}) {
    words += static_cast<char>(word & 0xFF);
    words += static_cast<char>(word >> 8);
  }
  const auto recording = OpenRecording({folder.Write("some.name", words)});
  int width = 0, height = 0;
  MeasureSize(recording.get(), &width, &height);
  EXPECT_EQ(width, 320);
  EXPECT_EQ(height, 320);
}

std::string Rows(int first, int width, int height, const std::string& last) {
  std::string text;
  for (int k = 0; k < 20'000; ++k)
    text += std::to_string(10 * k) + " " + std::to_string(first + k % width) + " " +
            std::to_string(first + k % height) + " 1\n";
  return text + last;
}

TEST(MeasureSize, ADamagedPixelIsLeftOut) {
  const TemporaryFolder folder("recognition");
  for (const char* last : {"", "200000 4000 7 1\n", "200000 7 70000 1\n"}) {
    const auto recording = OpenRecording({folder.Write("a.txt", Rows(0, 346, 260, last))});
    int width = 0, height = 0;
    MeasureSize(recording.get(), &width, &height);
    EXPECT_EQ(width, 346) << last;
    EXPECT_EQ(height, 260) << last;
  }
}

TEST(MeasureSize, PixelsThatCountFromOneAreRefused) {
  const TemporaryFolder folder("recognition");
  const auto recording = OpenRecording({folder.Write("a.txt", Rows(1, 346, 260, ""))});
  int width = 0, height = 0;
  EXPECT_THAT([&] { MeasureSize(recording.get(), &width, &height); },
              ThrowsMessage<std::runtime_error>(HasSubstr("counted from 1")));
}

TEST(OpenRecording, TextBelowCommentsOfPercentSignsIsText) {
  const TemporaryFolder folder("recognition");
  const auto recording =
      OpenRecording({folder.Write("a.csv", "% made by us\n% geometry 346x260\n" + Rows(0, 346, 260, ""))});
  EXPECT_THAT(recording->info().format, HasSubstr("text"));
}

TEST(OpenRecording, WhyTextCannotBeReadIsSaid) {
  const TemporaryFolder folder("recognition");
  const std::pair<std::string, std::string> cases[] = {
      {std::string("\xff\xfe") + std::string("1\0 \0", 4), "UTF-16"},
      {"0,31;1;2;1\n0,32;1;2;1\n", "decimal commas"},
      {"PK\x03\x04 no arrays", "unzip"},
      {"\n\n", "nothing but blanks"},
      {"t,x,y,p\n", "has no rows"},
      {"1|2|3|1\n", "has no rows of numbers"},
      {"rosbag2_bagfile_information:\n  version: 5\n", "give the folder"}};
  for (const auto& c : cases) {
    const std::string path = folder.Write("a.txt", c.first);
    EXPECT_THAT([&] { OpenRecording({path}); }, ThrowsMessage<std::runtime_error>(HasSubstr(c.second)));
  }
}

TEST(MeasureSize, ColumnsAndRowsThatAreSwappedAreRefused) {
  const TemporaryFolder folder("recognition");
  const auto recording = OpenRecording({folder.Write("a.txt", Rows(0, 260, 346, ""))});
  int width = 0, height = 0;
  EXPECT_THAT([&] { MeasureSize(recording.get(), &width, &height); },
              ThrowsMessage<std::runtime_error>(HasSubstr("columns and rows seem to be swapped")));
}

TEST(OpenRecording, AChoiceWhereThereIsNoneIsRefused) {
  const TemporaryFolder folder("recognition");
  const std::string path = folder.Write("a.txt", Rows(0, 346, 260, ""));
  StreamChoice choice;
  choice.events = "left";
  EXPECT_THAT([&] { OpenRecording({path}, choice); },
              ThrowsMessage<std::runtime_error>(HasSubstr("--events-topic left")));
  EXPECT_FALSE(HasImuTopics(path));
  EXPECT_FALSE(HasTruthTopics(path));
}

// Of bags of one recording those that are cut off give what is whole of them; what the others hold is
// complete.
TEST(OpenRecording, OfSeveralBagsOneMayBeCutOff) {
  constexpr Utime kStart = 1'700'000'000'000'000, kMessages = 3000;
  const TemporaryFolder folder("recognition");
  const std::string poses = folder.File("poses.bag"), imu = folder.File("imu.bag");
  {
    rosbag::Bag of_poses(poses, rosbag::bagmode::Write), of_imu(imu, rosbag::bagmode::Write);
    of_imu.setChunkThreshold(20'000);
    for (Utime k = 0; k < kMessages; ++k) {
      const Utime t = kStart + 1000 * k;
      Record(&of_poses, "/pose", t, PoseMessage({t, {}}));
      Record(&of_imu, "/imu", t, ImuMessage({t, {1, 2, 3}, {4, 5, 6}}));
    }
  }
  std::filesystem::resize_file(imu, std::filesystem::file_size(imu) / 2);
  StreamChoice choice;
  choice.take_events = false;
  const ImportStreams streams = OpenRecording({imu, poses}, choice)->Streams();
  EXPECT_EQ(streams.truth.size(), std::size_t{kMessages});
  EXPECT_FALSE(streams.dropped_truth.cut_off);
  EXPECT_LT(streams.imu.size(), std::size_t{kMessages});
  EXPECT_GT(streams.imu.size(), std::size_t{kMessages / 4});
  EXPECT_TRUE(streams.dropped_imu.cut_off);
  EXPECT_NEAR(streams.dropped_imu.lost_share, 0.5, 0.1);
}

}  // namespace
}  // namespace evit::formats
