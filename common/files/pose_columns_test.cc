#include "common/files/pose_columns.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace evit {
namespace {

using ::testing::ElementsAre;

// The row of a file with this head.
PoseRow Read(const std::string& head, const std::string& row) {
  const std::string text = head + "\n" + row + "\n";
  TableSample sample;
  {
    TableReader table(text, "poses", "a pose");
    table.Next();
    while (table.more()) sample.rows.resize(1), sample.rows[0].emplace_back(table.Word());
    sample.head = table.head();
  }
  TableReader table(text, "poses", "a pose");
  table.Next();
  return ReadPoseRow(PoseColumnsOf(sample), TimeUnit::kSeconds, &table);
}

TEST(PoseColumns, HeadsOfOtherProgramsSayTheOrder) {
  const struct {
    std::string head, row;
  } cases[] = {
      {"# timestamp tx ty tz qx qy qz qw", "7 1 2 3 0.1 0.2 0.3 0.9"},
      {"time,x,y,z,qw,qx,qy,qz", "7,1,2,3,0.9,0.1,0.2,0.3"},
      {"#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z "
       "[], "
       "v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1]",
       "7,1,2,3,0.9,0.1,0.2,0.3,5,5,5,6"},
      {"%time,field.header.seq,field.header.stamp,field.header.frame_id,field.pose.position.x,field.pose."
       "position.y,"
       "field.pose.position.z,field.pose.orientation.x,field.pose.orientation.y,field.pose.orientation.z,"
       "field.pose.orientation.w",
       "8,0,7,map,1,2,3,0.1,0.2,0.3,0.9"},
      {"secs,nsecs,tx,ty,tz,qx,qy,qz,qw", "6,1000000000,1,2,3,0.1,0.2,0.3,0.9"},
      {"header.stamp.sec,header.stamp.nanosec,frame,x,y,z,qx,qy,qz,qw", "7,0,map,1,2,3,0.1,0.2,0.3,0.9"},
      {"# ground truth of the arm", "7 1 2 3 0.1 0.2 0.3 0.9"},
      {"# x y z", "7 1 2 3 0.1 0.2 0.3 0.9"},  // names three of eight
  };
  for (const auto& c : cases) {
    const PoseRow row = Read(c.head, c.row);
    EXPECT_TRUE(row.timed) << c.head;
    EXPECT_EQ(row.t, 7'000'000) << c.head;
    EXPECT_THAT(row.position, ElementsAre(1, 2, 3)) << c.head;
    EXPECT_THAT(row.orientation, ElementsAre(0.1, 0.2, 0.3, 0.9)) << c.head;
  }
}

TEST(PoseColumns, MissingNumberIsAnError) {
  EXPECT_THROW(Read("time,x,y,z,qw,qx,qy,qz", "7,1,2,3,0.9,0.1,0.2"), std::runtime_error);
}

TEST(PoseColumns, MatricesAreToldFromPoses) {
  TableSample sample;
  sample.rows = {{"7", "0", "-1", "0", "0.1", "1", "0", "0", "0.2", "0", "0", "1", "0.3"}};
  EXPECT_TRUE(HoldsMatrices(sample));
  sample.rows[0][2] = "-0.5";  // no rotation
  EXPECT_FALSE(HoldsMatrices(sample));
  sample.rows = {{"7", "1", "2", "3", "0", "0", "0", "1", "5", "5", "5", "5", "5"}};
  EXPECT_FALSE(HoldsMatrices(sample));
}

}  // namespace
}  // namespace evit
