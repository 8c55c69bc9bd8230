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
      {"rostopic echo -p",
       "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.orientation.x,field."
       "orientation.y,"
       "field.orientation.z,field.orientation.w,field.orientation_covariance0,field.angular_velocity.x,"
       "field.angular_velocity.y,field.angular_velocity.z,field.angular_velocity_covariance0,"
       "field.linear_acceleration.x,field.linear_acceleration.y,field.linear_acceleration.z\n"
       "1000900000,1,1000000000,imu,0,0,0,1,0,0.1,0.2,0.3,0,0,0,9.81\n"
       "1005900000,2,1005000000,imu,0,0,0,1,0,0.1,0.2,0.3,0,0,0,9.81\n"},
      {"the magnetometer first, an index",
       "idx,t,mag_x,mag_y,mag_z,gyro_x,gyro_y,gyro_z,acc_x,acc_y,acc_z\n"
       "0,1.0,7,8,9,0.1,0.2,0.3,0,0,9.81\n1,1.005,7,8,9,0.1,0.2,0.3,0,0,9.81\n"},
      {"an orientation before",
       "t,qx,qy,qz,qw,wx,wy,wz,ax,ay,az\n1.0,0,0,0,1,0.1,0.2,0.3,0,0,9.81\n"
       "1.005,0,0,0,1,0.1,0.2,0.3,0,0,9.81\n"},
      {"in any order",
       "ax,wx,t_us,ay,wy,wz,az\n0,0.1,1000000,0,0.2,0.3,9.81\n0,0.1,1005000,0,0.2,0.3,9.81\n"},
      {"seconds and nanoseconds",
       "secs,nsecs,gx,gy,gz,ax,ay,az\n1,0,0.1,0.2,0.3,0,0,9.81\n"
       "1,5000000,0.1,0.2,0.3,0,0,9.81\n"},
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
  std::string split, degrees = "t,gyro_x_dps,gyro_y_dps,gyro_z_dps,ax [g],ay [g],az [g]\n";
  for (int k = 0; k < 20; ++k) {
    split += "17 " + std::to_string(5'000'000 * k) + " 0.1 0.2 0.3 0 0 9.81\n";
    degrees += "1." + std::to_string(100 + k) + ",180,0,0,0,0,1\n";
  }
  const std::vector<ImuSample> of_split = ReadImuTable(folder.Write("imu", split), &dropped);
  ASSERT_EQ(of_split.size(), 20U);
  EXPECT_EQ(of_split[2].t, 17'010'000);
  const std::vector<ImuSample> of_degrees = ReadImuTable(folder.Write("imu", degrees), &dropped);
  EXPECT_NEAR(of_degrees[0].gyro.x(), 3.14159265, 1e-6);
  EXPECT_NEAR(of_degrees[0].accel.z(), 9.80665, 1e-9);
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

TEST(StreamTables, ALastRowThatIsCutOffIsLeftOutAndTold) {
  const TemporaryFolder folder("tables");
  DropCounts imu, poses;
  EXPECT_EQ(
      ReadImuTable(folder.Write("imu", "1.0 0 0 9.81 0.1 0.2 0.3\n1.1 0 0 9.81 0.1 0.2 0.3\n1.2 0 0"), &imu)
          .size(),
      2U);
  EXPECT_TRUE(imu.cut_off);
  EXPECT_EQ(
      ReadPoseTable(folder.Write("gt", "1.0 1 2 3 0 0 0 1\n1.1 1 2 3 0 0 0 1\n1.2 1 2 3"), &poses).size(),
      2U);
  EXPECT_TRUE(poses.cut_off);
  DropCounts whole;
  EXPECT_EQ(ReadPoseTable(folder.Write("gt", "1.0 1 2 3 0 0 0 1\n1.1 1 2 3 0 0 0 1"), &whole).size(), 2U);
  EXPECT_FALSE(whole.cut_off);
  EXPECT_THROW(ReadPoseTable(folder.Write("gt", "1.0 1 2 3 0 0 0 1\n1.1 1 2 3\n"), &whole),
               std::runtime_error);
}

TEST(ReadImuTable, NamesThatDoNotSayItAllAreRefusedAmongOtherColumns) {
  const TemporaryFolder folder("tables");
  const std::string path = folder.Write("imu",
                                        "PacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z\n1,"
                                        "10000,0,0,9.81,0.1,0.2,0.3\n2,10050,0,0,9.81,0.1,0.2,0.3\n");
  DropCounts dropped;
  EXPECT_THAT([&] { ReadImuTable(path, &dropped); },
              ThrowsMessage<std::runtime_error>(HasSubstr("not known: PacketCounter, SampleTimeFine")));
}

TEST(ReadPoseTable, MatricesAreRefused) {
  const TemporaryFolder folder("tables");
  const std::string path =
      folder.Write("gt", "7 0 -1 0 0.01 1 0 0 0.2 0 0 1 0.3\n8 0 -1 0 0.01 1 0 0 0.2 0 0 1 0.3\n");
  DropCounts dropped;
  EXPECT_THAT([&] { ReadPoseTable(path, &dropped); },
              ThrowsMessage<std::runtime_error>(HasSubstr("holds matrices")));
}

}  // namespace
}  // namespace evit::formats
