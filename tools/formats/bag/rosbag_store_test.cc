#include "tools/formats/bag/rosbag_store.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/helpers/all_events.h"
#include "tests/helpers/ros_bags.h"
#include "tests/helpers/temporary_folder.h"
#include "tools/formats/bag/cut_bag.h"
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

// Cut anywhere, a bag gives its whole chunks, and says how much is missing.
TEST(RosbagStore, OfABagThatIsCutOffTheWholeChunksAreRead) {
  const TemporaryFolder folder("rosbag");
  constexpr Utime kMessages = 3000;
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const std::string path = folder.File("whole.bag");
    {
      rosbag::Bag bag(path, rosbag::bagmode::Write);
      bag.setCompression(compression);
      bag.setChunkThreshold(20'000);
      for (Utime k = 0; k < kMessages; ++k) {
        const Utime t = kStart + 1000 * k;
        Record(&bag, "/cam", t, PacketMessage(t, 70'000 + 1000 * k));
        Record(&bag, "/imu", t, ImuMessage({t, {1, 2, 3}, {4, 5, 6}}));
      }
    }
    EXPECT_FALSE(CutBag::Recognises(path));
    const auto whole = std::filesystem::file_size(path);
    for (const double share : {0.3, 0.8, 0.999}) {
      SCOPED_TRACE(testing::Message() << "compression " << compression << ", cut at " << share);
      const std::string cut = folder.File("cut.bag");
      std::filesystem::copy_file(path, cut, std::filesystem::copy_options::overwrite_existing);
      std::filesystem::resize_file(cut, static_cast<std::uintmax_t>(share * static_cast<double>(whole)));
      ASSERT_TRUE(CutBag::Recognises(cut));
      RosRecording recording(std::make_unique<CutBag>(cut), {});
      DropCounts dropped;
      const EventArray e = AllEvents(&recording, 640, 480, &dropped);
      EXPECT_TRUE(dropped.cut_off);
      EXPECT_GT(static_cast<double>(e.size()), (share - 0.2) * kMessages);
      if (share > 0.99) {
        EXPECT_EQ(e.size(), std::size_t{kMessages}) << "only the index is missing";
      } else {
        EXPECT_LT(e.size(), std::size_t{kMessages});
        EXPECT_NEAR(dropped.lost_share, 1 - share, 0.1);
      }
      EXPECT_EQ(e.t.front(), kStart);
      // A chunk may end between the two messages of an instant.
      EXPECT_NEAR(static_cast<double>(recording.Streams().imu.size()), static_cast<double>(e.size()), 1);
      EXPECT_FALSE(recording.Streams().dropped_imu.cut_off) << "said of the events";
      RosTopics imu_alone;
      imu_alone.take_events = imu_alone.take_truth = false;
      const ImportStreams alone = RosRecording(std::make_unique<CutBag>(cut), imu_alone).Streams();
      EXPECT_TRUE(alone.dropped_imu.cut_off);
      EXPECT_EQ(alone.dropped_imu.lost_share, dropped.lost_share);
    }
    std::filesystem::resize_file(path, 5000);
    EXPECT_THROW(CutBag{path}, std::runtime_error);
  }
}

// As a recorder that was killed leaves it: no index, sizes of 0 before the last chunk, and its end unwritten.
TEST(RosbagStore, OfABagWhoseRecordingWasNotEndedNothingWholeIsLost) {
  const TemporaryFolder folder("rosbag");
  constexpr Utime kMessages = 3000;
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const bool packed = compression != rosbag::compression::Uncompressed;
    for (const bool more : {false, true}) {
      SCOPED_TRACE(testing::Message() << "compression " << compression << ", more: " << more);
      const std::string path = folder.File("a.bag"), active = folder.File("a.bag.active");
      rosbag::Bag bag(path, rosbag::bagmode::Write);
      bag.setCompression(compression);
      bag.setChunkThreshold(60'000);
      for (Utime k = 0; k < kMessages; ++k)
        Record(&bag, "/cam", kStart + 1000 * k, PacketMessage(kStart + 1000 * k, 70'000 + 1000 * k));
      std::filesystem::copy_file(path, active, std::filesystem::copy_options::overwrite_existing);
      // A part of a packed chunk, or of a record.
      if (more) std::ofstream(active, std::ios::app) << std::string(1000, packed ? '\xE7' : '\x01');
      ASSERT_TRUE(CutBag::Recognises(active));
      RosRecording recording(std::make_unique<CutBag>(active), {});
      DropCounts dropped;
      const EventArray e = AllEvents(&recording, 640, 480, &dropped);
      EXPECT_TRUE(dropped.cut_off);
      // What the recorder held back: 4 kB, or a chunk that is being packed.
      const Utime held = (packed ? 60'000 : 4096) / 100;
      EXPECT_GT(static_cast<Utime>(e.size()), kMessages - held);
      EXPECT_LT(static_cast<Utime>(e.size()), kMessages);
      EXPECT_EQ(e.t.front(), kStart);
    }
  }
}

}  // namespace
}  // namespace evit::formats
