#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <numeric>

#include "tests/helpers/ros2_sample_bag.h"
#include "tests/helpers/temporary_folder.h"
#include "tools/formats/ros/message_types.h"

namespace evit::formats {
namespace {

using ros2::WriteSqlite;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Ros2Recording, BothOrdersOfBytesAreReadOthersRefused) {
  const TemporaryFolder folder("ros2");
  std::vector<Message> messages = Recording(true);
  WriteSqlite(folder.File("big.db3"), messages);
  ExpectWhole(folder.File("big.db3"));
  messages[0].bytes[1] = 2;  // a list of parameters
  WriteSqlite(folder.File("list.db3"), messages);
  EXPECT_THAT([&] { RosRecording(OpenRos2Bag(folder.File("list.db3")), {}); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr("list.db3: /cam/events"), HasSubstr("encapsulation 2"))));
}

TEST(Ros2Recording, EventArraysAreRead) {
  const TemporaryFolder folder("ros2");
  Cdr array;
  array.Header(kStart).Put(std::uint32_t{260}).Put(std::uint32_t{346}).Put(std::uint32_t{3});
  for (std::uint16_t k = 0; k < 3; ++k)
    array.Put(k)
        .Put(static_cast<std::uint16_t>(2 * k))
        .Time(kStart + k)
        .Put(static_cast<std::uint8_t>(k % 2));
  std::vector<Message> messages = Recording();
  messages[0].bytes = array.bytes();
  messages.resize(1);
  WriteSqlite(folder.File("a.db3"), messages);
  sqlite3* db = nullptr;
  sqlite3_open(folder.File("a.db3").c_str(), &db);
  sqlite3_exec(db, "UPDATE topics SET type='dvs_msgs/msg/EventArray' WHERE name='/cam/events'", nullptr,
               nullptr, nullptr);
  sqlite3_close(db);
  RosRecording recording(OpenRos2Bag(folder.File("a.db3")), {});
  EXPECT_EQ(recording.info().width, 346);
  const EventArray e = AllEvents(&recording, 346, 260);
  EXPECT_EQ(e.t, (std::vector<Utime>{kStart, kStart + 1, kStart + 2}));
  EXPECT_EQ(e.x, (std::vector<std::uint16_t>{0, 1, 2}));
  EXPECT_EQ(e.y, (std::vector<std::uint16_t>{0, 2, 4}));
  EXPECT_EQ(e.p, (std::vector<std::uint8_t>{0, 1, 0}));
}

// Two frames in each message of /tf, at x = 0, 1, ... and -1, -2, ...
std::vector<Message> WithTransforms() {
  std::vector<Message> messages = Recording();
  for (Utime k = 0; k < 3; ++k) {
    const Utime t = kStart + 3'000 * k;
    Cdr transforms;
    transforms.Put(std::uint32_t{2});
    transforms.Header(t, "mocap").Text("drone").Doubles({static_cast<double>(k), 2, 3, 0, 0, 0, 1});
    transforms.Header(t, "drone").Text("gimbal").Doubles({-1.0 - static_cast<double>(k), 0, 0, 0, 0, 1, 0});
    messages.push_back({"/tf", transforms.bytes(), t});
  }
  return messages;
}

TEST(Ros2Recording, ThePosesOfAFrameOfTfMayBeTheTruth) {
  const TemporaryFolder folder("ros2");
  const std::string bag = folder.File("a.db3");
  WriteSqlite(bag, WithTransforms());
  EXPECT_EQ(RosRecording(OpenRos2Bag(bag), {}).Streams().truth.size(), 2U) << "unasked, /odom is the truth";
  RosRecording recording(OpenRos2Bag(bag), {"", "", "/tf", "drone"});
  const ImportStreams streams = recording.Streams();
  ASSERT_EQ(streams.truth.size(), 3U);
  for (Utime k = 0; k < 3; ++k) {
    EXPECT_EQ(streams.truth[k].t, kStart + 3'000 * k);
    EXPECT_EQ(streams.truth[k].pose.p, Eigen::Vector3d(static_cast<double>(k), 2, 3));
  }
  const auto error = [&](const std::string& topic, const std::string& frame, const std::string& text) {
    EXPECT_THAT(
        [&] {
          RosRecording(OpenRos2Bag(bag), {"", "", topic, frame});
        },
        ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("a.db3"), HasSubstr(text))));
  };
  error("/tf", "",
        "/tf: choose the frame whose poses are the truth with --truth-frame; frames: drone (in mocap), "
        "gimbal (in drone)");
  error("/tf", "dron", "--truth-frame dron: there is no such frame");
  error("/odom", "drone", "--truth-frame drone chooses a frame of a topic of type tf2_msgs/TFMessage");
}

TEST(Ros2Recording, AFrameOfTwoParentsIsNoTruth) {
  const TemporaryFolder folder("ros2");
  std::vector<Message> messages = WithTransforms();
  Cdr other;
  other.Put(std::uint32_t{1}).Header(kStart + 9'000, "odom").Text("drone").Doubles({0, 0, 0, 0, 0, 0, 1});
  messages.push_back({"/tf", other.bytes(), kStart + 9'000});
  WriteSqlite(folder.File("a.db3"), messages);
  EXPECT_THAT(
      [&] {
        RosRecording(OpenRos2Bag(folder.File("a.db3")), {"", "", "/tf", "drone"});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("drone: its poses are given in several frames")));
  Cdr again;
  again.Put(std::uint32_t{1}).Header(kStart + 10'000, "map").Text("drone").Doubles({0, 0, 0, 0, 0, 0, 1});
  WriteSqlite(folder.File("alone.db3"), {messages.back(), {"/tf", again.bytes(), kStart + 10'000}});
  EXPECT_THAT(
      [&] {
        RosRecording(OpenRos2Bag(folder.File("alone.db3")), {"", "", "/tf", ""});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("drone: its poses are given in several frames")));
}

TEST(Ros2Recording, WhatIsMissingOrWrongIsNamed) {
  const TemporaryFolder folder("ros2");
  std::vector<Message> messages = Recording();
  messages[0].bytes.resize(60);
  WriteSqlite(folder.File("a.db3"), messages);
  EXPECT_THAT([&] { RosRecording(OpenRos2Bag(folder.File("a.db3")), {}); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr("a.db3: /cam/events, message"), HasSubstr("the bag is damaged"))));
  EXPECT_THAT(
      [&] {
        RosRecording(OpenRos2Bag(folder.File("a.db3")), {"", "/odom", "", ""});
      },
      ThrowsMessage<std::runtime_error>(
          AllOf(HasSubstr("--imu-topic /odom"), HasSubstr("/imu (sensor_msgs/Imu)"))));
  EXPECT_EQ(OpenRos2Bag(folder.Write("a.txt", "no bag")), nullptr);
}

// Sums over all events as the message package's own test states them (stamps of the sensor, ns).
TEST(Ros2Recording, ARealBagOfEvt3PacketsHasItsPublishedSums) {
  const std::string path = SharedFile("formats/evt3_trigger_0.db3");
  if (path.empty()) GTEST_SKIP() << "no recordings (EVIT_SHARED_DATA)";
  const auto store = OpenRos2Bag(path);
  ASSERT_NE(store, nullptr);
  const auto pass = store->Read({"/event_camera/events"});
  EventPacketDecoder decoder;
  EventArray e;
  RosMessage message;
  while (pass->Next(&message))
    decoder.Decode(GetEventPacket(RosCursor(message.data, message.size, true)), &e);
  EXPECT_EQ(1000 * std::accumulate(e.t.begin(), e.t.end(), Utime{0}), 1'222'326'831'810'000);
  EXPECT_EQ(std::accumulate(e.x.begin(), e.x.end(), 0), 42'078'718);
  EXPECT_EQ(std::accumulate(e.y.begin(), e.y.end(), 0), 31'656'267);
  EXPECT_EQ(std::accumulate(e.p.begin(), e.p.end(), 0), 41'439);
}

TEST(Ros2Recording, RealBagsAreReadWhole) {
  for (const auto& [name, width, height] :
       {std::tuple("formats/evt3_trigger_0.db3", 1280, 720), std::tuple("formats/events_1.db3", 640, 480)}) {
    const std::string path = SharedFile(name);
    if (path.empty()) GTEST_SKIP() << "no recordings (EVIT_SHARED_DATA)";
    RosRecording recording(OpenRos2Bag(path), {});
    EXPECT_EQ(recording.info().width, width);
    EXPECT_EQ(recording.info().height, height);
    DropCounts dropped;
    const EventArray e = AllEvents(&recording, width, height, &dropped);
    EXPECT_GT(e.size(), 50'000U);
    EXPECT_LT(dropped.total(), 10);
    std::printf("%s: %zu events, %.6f s, dropped %lld (unstamped %lld)\n", name, e.size(),
                1e-6 * static_cast<double>(e.t.back() - e.t.front()), static_cast<long long>(dropped.total()),
                static_cast<long long>(dropped.unstamped));
  }
}

}  // namespace
}  // namespace evit::formats
