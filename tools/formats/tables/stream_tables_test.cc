#include "tools/formats/tables/stream_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/helpers/temporary_folder.h"

namespace evit::formats {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(ReadImuTable, ColumnsAndUnitsAreFoundByNameOrByGravity) {
  const TemporaryFolder folder("tables");
  const struct {
    const char *what, *text;
  } cases[] = {
      {"TUM-VIE",
       "# timestamp(us) gyro_x gyro_y gyro_z accel_x accel_y accel_z temperature\n"
       "1000000 0.1 0.2 0.3 0 0 9.81 31\n1005000 0.1 0.2 0.3 0 0 9.81 31\n"},
      {"RPG", "1.000000 0 0 9.81 0.1 0.2 0.3\n1.005000 0 0 9.81 0.1 0.2 0.3\n"},
      {"VECtor", "1.000000 0.1 0.2 0.3 0 0 9.81 0 0 0 1\n1.005000 0.1 0.2 0.3 0 0 9.81 0 0 0 1\n"},
      {"EuRoC",
       "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m "
       "s^-2],a_RS_S_y [m "
       "s^-2],a_RS_S_z [m s^-2]\n1000000000,0.1,0.2,0.3,0,0,9.81\n1005000000,0.1,0.2,0.3,0,0,9.81\n"},
      {"named, accelerations first",
       "t[us],acc_x,acc_y,acc_z,gyr_x,gyr_y,gyr_z\n1000000,0,0,9.81,0.1,0.2,0.3\n1005000,0,0,9.81,0.1,0.2,0."
       "3\n"}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.what);
    DropCounts dropped;
    const std::vector<ImuSample> samples = ReadImuTable(folder.Write("imu", c.text), &dropped);
    ASSERT_EQ(samples.size(), 2U);
    EXPECT_EQ(samples[0].t, 1'000'000);
    EXPECT_EQ(samples[1].t, 1'005'000);
    EXPECT_EQ(samples[1].gyro, Eigen::Vector3d(0.1, 0.2, 0.3));
    EXPECT_EQ(samples[1].accel, Eigen::Vector3d(0, 0, 9.81));
  }
  DropCounts dropped;
  EXPECT_THAT([&] { ReadImuTable(folder.Write("imu", "1 0 0 0 0 0 0\n1.1 0 0 0 0 0 0\n"), &dropped); },
              ThrowsMessage<std::runtime_error>(HasSubstr("which columns are accelerations")));
}

TEST(ReadPoseTable, TumAndEurocAndMicroseconds) {
  const TemporaryFolder folder("tables");
  for (const char* text :
       {"1.000000 1 2 3 0 0 0.6 0.8\n1.100000 1 2 3 0 0 0.6 0.8\n",
        "# timestamp[us] px py pz qx qy qz qw\n1000000 1 2 3 0 0 0.6 0.8\n1100000 1 2 3 0 0 0.6 0.8\n",
        "#timestamp,p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n"
        "1000000000000000000,1,2,3,0.8,0,0,0.6\n1000000000100000000,1,2,3,0.8,0,0,0.6\n"}) {
    DropCounts dropped;
    const Trajectory poses = ReadPoseTable(folder.Write("poses", text), &dropped);
    ASSERT_EQ(poses.size(), 2U) << text;
    EXPECT_EQ(poses[1].t - poses[0].t, 100'000) << text;
    EXPECT_EQ(poses[1].pose.p, Eigen::Vector3d(1, 2, 3));
    EXPECT_TRUE(poses[1].pose.q.coeffs().isApprox(Eigen::Vector4d(0, 0, 0.6, 0.8))) << text;
  }
}

}  // namespace
}  // namespace evit::formats
