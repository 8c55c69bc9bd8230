#include "tools/formats/bag/bag_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/helpers/ros_bags.h"
#include "tools/formats/bag/ros_messages.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class BagFilesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    for (int k = 0; k < 1000; ++k) {
      ImuSample s;
      s.t = Utime{1'600'000'000'000'000} + k;
      Record(&bag, "/imu/a", s.t, ImuMessage(s));
      Record(&bag, "/imu/b", s.t, ImuMessage(s));
      Record(&bag, "/gt", s.t, PoseMessage({s.t, {}}));
    }
  }
  void TearDown() override { std::filesystem::remove(path_); }

  const std::string path_ = ::testing::TempDir() + "/bag_files_" + std::to_string(getpid()) + ".bag";
};

TEST_F(BagFilesTest, TopicsAreFoundByTypeOrName) {
  const BagFiles files({path_});
  EXPECT_EQ(files.FindTopic(kTruthTypes, "", "--truth-topic"), "/gt");
  EXPECT_EQ(files.FindTopic(kImuTypes, "/imu/b", "--imu-topic"), "/imu/b");
  EXPECT_EQ(files.FindTopic(kEventTypes, "", "--events-topic"), "");
  EXPECT_THAT([&] { files.FindTopic(kImuTypes, "", "--imu-topic"); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr(path_), HasSubstr("--imu-topic"), HasSubstr("/imu/a, /imu/b"))));
  for (const char* wrong : {"/gt", "/none"}) {
    EXPECT_THAT([&] { files.FindTopic(kImuTypes, wrong, "--imu-topic"); },
                ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("--imu-topic " + std::string(wrong)),
                                                        HasSubstr("/imu/a (sensor_msgs/Imu)"))));
  }
}

TEST_F(BagFilesTest, IncompleteBagsAreRejected) {
  const auto size = std::filesystem::file_size(path_);
  for (const double share : {0.99, 0.5, 0.1, 0.001, 0.0}) {
    std::filesystem::resize_file(path_, static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    EXPECT_THAT([&] { BagFiles({path_}); }, ThrowsMessage<std::runtime_error>(HasSubstr(path_))) << share;
  }
  std::ofstream(path_) << "this is not a bag\n";
  EXPECT_THAT([&] { BagFiles({path_}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("not a complete ROS 1 bag")));
  EXPECT_THAT(
      [&] {
        BagFiles({path_, "/no/such.bag"});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr(path_)));
  EXPECT_THAT([&] { BagFiles({"/no/such.bag"}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("there is no such file")));
}

}  // namespace
}  // namespace evit::formats
