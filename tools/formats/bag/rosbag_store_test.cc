#include "tools/formats/bag/rosbag_store.h"

#include <gtest/gtest.h>

#include "tests/helpers/all_events.h"
#include "tests/helpers/ros_bags.h"
#include "tests/helpers/temporary_folder.h"
#include "tools/formats/ros/ros_recording.h"

namespace evit::formats {
namespace {

constexpr Utime kStart = 1'700'000'000'000'000;

void PutText(const std::string& text, RosBytes* out) {
  out->Put(static_cast<std::uint32_t>(text.size()));
  for (const char c : text) out->Put(c);
}

// An EventPacket with one event, of a sensor whose clock stands at `sensor` us.
RawMessage PacketMessage(Utime stamp, Utime sensor) {
  RosBytes out;
  out.Header(stamp)
      .Put(std::uint32_t{480})
      .Put(std::uint32_t{640})
      .Put(std::uint64_t{3})
      .Put(std::uint64_t{0});
  PutText("evt3", &out);
  out.Put(std::uint8_t{0}).Put(std::uint32_t{10});
  const auto high = static_cast<std::uint16_t>(0x8000 | (sensor >> 12));
  out.Put(high).Put(static_cast<std::uint16_t>(0x6000 | (sensor & 0xFFF))).Put(std::uint16_t{100});
  out.Put(std::uint16_t{0x2800 | 200}).Put(high);
  return {"event_camera_msgs/EventPacket", out.bytes()};
}

TEST(RosbagStore, EventPacketsWithImuAndOdometryAreOneRecording) {
  const TemporaryFolder folder("rosbag");
  {
    rosbag::Bag events(folder.File("events.bag"), rosbag::bagmode::Write),
        rest(folder.File("rest.bag"), rosbag::bagmode::Write);
    for (Utime k = 0; k < 3; ++k)
      Record(&events, "/cam", kStart + 1000 * k, PacketMessage(kStart + 1000 * k, 70'000 + 1000 * k));
    Record(&rest, "/imu", kStart, ImuMessage({kStart, {1, 2, 3}, {4, 5, 6}}));
    RosBytes odometry;
    odometry.Header(kStart);
    PutText("base", &odometry);
    odometry.Doubles({1, 2, 3, 0, 0, 0, 1}).Doubles(std::vector<double>(36 + 6 + 36, 0));
    Record(&rest, "/odom", kStart, RawMessage{"nav_msgs/Odometry", odometry.bytes()});
  }
  const std::vector<std::string> files = {folder.File("rest.bag"), folder.File("events.bag")};
  for (const std::string& file : files) EXPECT_TRUE(RosbagStore::Recognises(file));
  RosRecording recording(std::make_unique<RosbagStore>(files), {});
  EXPECT_EQ(recording.info().format, "ROS 1 bag, event_camera_msgs/EventPacket (evt3)");
  EXPECT_EQ(recording.info().width, 640);
  const EventArray e = AllEvents(&recording, 640, 480);
  EXPECT_EQ(e.t, (std::vector<Utime>{kStart, kStart + 1000, kStart + 2000}));
  EXPECT_EQ(e.x, std::vector<std::uint16_t>(3, 200));
  const ImportStreams streams = recording.Streams();
  ASSERT_EQ(streams.imu.size(), 1U);
  EXPECT_EQ(streams.imu[0].accel, Eigen::Vector3d(4, 5, 6));
  ASSERT_EQ(streams.truth.size(), 1U);
  EXPECT_EQ(streams.truth[0].pose.p, Eigen::Vector3d(1, 2, 3));
}

}  // namespace
}  // namespace evit::formats
