#include "tools/formats/vector/imu_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace evit::formats {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::string Write(const std::string& text) {
  std::string path = ::testing::TempDir() + "/imu_file_test_" + std::to_string(::getpid()) + ".txt";
  std::ofstream(path) << text;
  return path;
}

constexpr char kHead[] = "# IMU\n# raw\n# timestamp gx gy gz ax ay az qx qy qz qw\n";

TEST(ImuFile, ReadsExactMicroseconds) {
  const auto samples =
      ReadImuFile(Write(std::string(kHead) + "1642661138.836531 0.1 0.2 0.3 1 2 9.8 0 0 0 1\n"
                                             "1642661138.841531 0.1 0.2 0.4 1 2 9.7 0 0 0 1\n"));
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[0].t, 1'642'661'138'836'531);
  EXPECT_EQ(samples[1].gyro, Eigen::Vector3d(0.1, 0.2, 0.4));
  EXPECT_EQ(samples[1].accel, Eigen::Vector3d(1, 2, 9.7));
}

TEST(ImuFile, NamesTheLineOfABadRow) {
  const std::string good = "1.0 0 0 0 0 0 9.8\n";
  for (const auto& [row, what] :
       {std::pair("1.005 0 0 0 0\n", "gx gy gz ax ay az"), std::pair("x 0 0 0 0 0 0\n", "decimal"),
        std::pair("1.005 0 0 nan 0 0 0\n", "finite"), std::pair("0.9 0 0 0 0 0 0\n", "increase")}) {
    const auto read = [text = kHead + good + row] { ReadImuFile(Write(text)); };
    EXPECT_THAT(read, ThrowsMessage<std::runtime_error>(HasSubstr(":5: ")));
    EXPECT_THAT(read, ThrowsMessage<std::runtime_error>(HasSubstr(what)));
  }
  EXPECT_THROW(ReadImuFile(Write(kHead)), std::runtime_error);
  EXPECT_THROW(ReadImuFile("/no/such/file"), std::runtime_error);
}

}  // namespace
}  // namespace evit::formats
