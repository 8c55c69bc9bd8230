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
  DropCounts dropped;
  const auto samples =
      ReadImuFile(Write(std::string(kHead) + "1642661138.836531 0.1 0.2 0.3 1 2 9.8 0 0 0 1\n"
                                             "1642661138.841531 0.1 0.2 0.4 1 2 9.7 0 0 0 1\n"),
                  &dropped);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[0].t, 1'642'661'138'836'531);
  EXPECT_EQ(samples[1].gyro, Eigen::Vector3d(0.1, 0.2, 0.4));
  EXPECT_EQ(samples[1].accel, Eigen::Vector3d(1, 2, 9.7));
}

TEST(ImuFile, NamesTheLineOfABadRow) {
  const std::string good = "1.0 0 0 0 0 0 9.8\n";
  for (const auto& [row, what] :
       {std::pair("1.005 0 0 0 0\n", "gx gy gz ax ay az"), std::pair("x 0 0 0 0 0 0\n", "not a time"),
        std::pair("1.005 0 0 y 0 0 0\n", "not a number")}) {
    DropCounts dropped;
    const auto read = [&, text = kHead + good + row] { ReadImuFile(Write(text), &dropped); };
    EXPECT_THAT(read, ThrowsMessage<std::runtime_error>(HasSubstr(":5: ")));
    EXPECT_THAT(read, ThrowsMessage<std::runtime_error>(HasSubstr(what)));
  }
  DropCounts dropped;
  EXPECT_THROW(ReadImuFile(Write(kHead), &dropped), std::runtime_error);
  EXPECT_THROW(ReadImuFile("/no/such/file", &dropped), std::runtime_error);
}

TEST(ImuFile, RowsThatAreNotFiniteAreCounted) {
  DropCounts dropped;
  EXPECT_EQ(
      ReadImuFile(Write("1.0 0 0 0 0 0 9.8\n1.005 0 0 nan 0 0 9\n1.01 0 0 0 0 0 9.8\n"), &dropped).size(),
      2U);
  EXPECT_EQ(dropped.invalid, 1);
}

// EuRoC's head: nanoseconds, and the accelerometer may come first where the names say so.
TEST(ImuFile, HeadsGiveOrderAndUnits) {
  DropCounts dropped;
  for (const char* text :
       {"#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m "
        "s^-2],a_RS_S_y "
        "[m s^-2],a_RS_S_z [m s^-2]\n1642661138000000000,1,2,3,4,5,6\n1642661138005000000,1,2,3,4,5,6\n",
        "ax,ay,az,gx,gy,gz,t_us\n4,5,6,1,2,3,1642661138000000\n4,5,6,1,2,3,1642661138005000\n",
        ",timestamp,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z\n0,1642661138.0,4,5,6,1,2,3\n1,1642661138.005,4,5,"
        "6,1,2,3\n"}) {
    const auto samples = ReadImuFile(Write(text), &dropped);
    ASSERT_EQ(samples.size(), 2U) << text;
    EXPECT_EQ(samples[1].t, 1'642'661'138'005'000) << text;
    EXPECT_EQ(samples[1].gyro, Eigen::Vector3d(1, 2, 3)) << text;
    EXPECT_EQ(samples[1].accel, Eigen::Vector3d(4, 5, 6)) << text;
  }
}

}  // namespace
}  // namespace evit::formats
