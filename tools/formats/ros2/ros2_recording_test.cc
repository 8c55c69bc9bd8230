#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <numeric>

#include "tests/helpers/all_events.h"
#include "tests/helpers/ros2_bags.h"
#include "tests/helpers/temporary_folder.h"
#include "tools/formats/ros/message_types.h"
#include "tools/formats/ros/ros_recording.h"
#include "tools/formats/ros2/bag_folder.h"

namespace evit::formats {
namespace {

using ros2::Cdr;
using ros2::Mcap;
using ros2::Message;
using ros2::WriteSqlite;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr Utime kStart = 1'700'000'000'000'000;

std::string Words(const std::vector<std::uint16_t>& words) {
  return {reinterpret_cast<const char*>(words.data()), 2 * words.size()};
}

std::string Packet(Utime stamp, const std::string& encoding, std::uint64_t time_base, const std::string& data,
                   bool big_endian = false) {
  return Cdr(big_endian)
      .Header(stamp)
      .Put(std::uint32_t{480})
      .Put(std::uint32_t{640})
      .Put(std::uint64_t{7})
      .Put(time_base)
      .Text(encoding)
      .Put(std::uint8_t{0})
      .Raw(data)
      .bytes();
}

// Two packets of a sensor whose clock stands at 5 s when the host's is at kStart, with IMU and truth.
std::vector<Message> Recording(bool big_endian = false) {
  std::vector<Message> messages;
  for (Utime k = 0; k < 2; ++k) {
    const Utime sensor = 5'000'000 + 10'000 * k;
    const auto high = static_cast<std::uint16_t>(0x8000 | (sensor >> 12 & 0xFFF));
    messages.push_back({"/cam/events",
                        Packet(kStart + 10'000 * k, "evt3", 0,
                               Words({high, static_cast<std::uint16_t>(0x6000 | (sensor & 0xFFF)), 0x0010,
                                      0x2805, 0x2006, high}),
                               big_endian),
                        kStart + 10'000 * k + 300});
    const std::vector<double> covariance(9, 0);
    messages.push_back({"/imu",
                        Cdr(big_endian)
                            .Header(kStart + 5'000 * k)
                            .Doubles({0, 0, 0, 1})
                            .Doubles(covariance)
                            .Doubles({0.1, 0.2, 0.3})
                            .Doubles(covariance)
                            .Doubles({0, 0, 9.81})
                            .Doubles(covariance)
                            .bytes(),
                        kStart + 5'000 * k});
    messages.push_back({"/odom",
                        Cdr(big_endian)
                            .Header(kStart + 4'000 * k)
                            .Text("body")
                            .Doubles({1, 2, 3, 0, 0, 0, 1})
                            .Doubles(std::vector<double>(36, 0))
                            .bytes(),
                        kStart + 4'000 * k});
  }
  return messages;
}

void ExpectWhole(const std::string& path) {
  RosRecording recording(OpenRos2Bag(path), {});
  EXPECT_EQ(recording.info().width, 640);
  EXPECT_EQ(recording.info().height, 480);
  const EventArray e = AllEvents(&recording, 640, 480);
  EXPECT_EQ(e.t, (std::vector<Utime>{kStart, kStart, kStart + 10'000, kStart + 10'000}));
  EXPECT_EQ(e.x, (std::vector<std::uint16_t>{5, 6, 5, 6}));
  EXPECT_EQ(e.y, std::vector<std::uint16_t>(4, 16));
  EXPECT_EQ(e.p, (std::vector<std::uint8_t>{1, 0, 1, 0}));
  const ImportStreams streams = recording.Streams();
  ASSERT_EQ(streams.imu.size(), 2U);
  EXPECT_EQ(streams.imu[1].t, kStart + 5'000);
  EXPECT_EQ(streams.imu[1].gyro, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(streams.imu[1].accel, Eigen::Vector3d(0, 0, 9.81));
  ASSERT_EQ(streams.truth.size(), 2U);
  EXPECT_EQ(streams.truth[1].t, kStart + 4'000);
  EXPECT_EQ(streams.truth[1].pose.p, Eigen::Vector3d(1, 2, 3));
}

TEST(Ros2Recording, SqliteBagsAreRead) {
  const TemporaryFolder folder("ros2");
  WriteSqlite(folder.File("a.db3"), Recording());
  ExpectWhole(folder.File("a.db3"));
}

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

// Cut anywhere behind its first messages, such a bag gives what is whole; nearer to its beginning it is
// refused.
TEST(Ros2Recording, OfASqliteBagThatIsCutOffTheBeginningIsRead) {
  const TemporaryFolder folder("ros2");
  std::vector<Message> messages;
  for (Utime k = 0; k < 400; ++k) {
    for (Message m : Recording()) {
      if (m.topic != "/cam/events") continue;
      m.t += 20'000 * k;
      messages.push_back(m);
    }
  }
  const std::string path = folder.File("a.db3");
  WriteSqlite(path, messages);
  RosRecording complete(OpenRos2Bag(path), {});
  DropCounts dropped;
  const std::size_t all = AllEvents(&complete, 640, 480, &dropped).size();
  EXPECT_FALSE(dropped.cut_off);
  const auto whole = static_cast<double>(std::filesystem::file_size(path));
  std::size_t least = 0;
  for (const double share : {0.5, 0.8, 0.97}) {
    const std::string cut = folder.File("cut.db3");
    std::filesystem::copy_file(path, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, static_cast<std::uintmax_t>(share * whole));
    RosRecording recording(OpenRos2Bag(cut), {});
    dropped = {};
    const std::size_t n = AllEvents(&recording, 640, 480, &dropped).size();
    EXPECT_GT(n, least) << share;
    EXPECT_LT(n, all) << share;
    EXPECT_GT(static_cast<double>(n), 0.7 * share * static_cast<double>(all)) << share;
    EXPECT_TRUE(dropped.cut_off) << share;
    EXPECT_NEAR(dropped.lost_share, 1 - share, 0.01);
    EXPECT_THAT(DropText(dropped, "events"), HasSubstr("% of the file"));
    least = n;
  }
  // Nor does a file that is taken for its other streams lose their ends without a word.
  std::vector<Message> with_truth;
  for (Utime k = 0; k < 400; ++k) {
    for (Message m : Recording()) {
      m.t += 20'000 * k;
      with_truth.push_back(m);
    }
  }
  const std::string rest = folder.File("rest.db3");
  WriteSqlite(rest, with_truth);
  RosTopics topics;
  topics.take_events = false;
  EXPECT_FALSE(RosRecording(OpenRos2Bag(rest), topics).Streams().dropped_truth.cut_off);
  std::filesystem::resize_file(rest, std::filesystem::file_size(rest) / 2);
  const ImportStreams cut = RosRecording(OpenRos2Bag(rest), topics).Streams();
  EXPECT_LT(cut.truth.size(), 800U);
  for (const DropCounts& counts : {cut.dropped_imu, cut.dropped_truth}) {
    EXPECT_TRUE(counts.cut_off);
    EXPECT_NEAR(counts.lost_share, 0.5, 0.01);
  }
  std::filesystem::resize_file(path, 2000);
  EXPECT_THAT([&] { OpenRos2Bag(path); }, ThrowsMessage<std::runtime_error>(HasSubstr("a.db3")));
}

TEST(Ros2Recording, McapFilesAreReadPlainAndInChunks) {
  const TemporaryFolder folder("ros2");
  for (const char* compression : {"-", "", "lz4", "zstd"}) {
    for (const bool summary : {false, true}) {
      SCOPED_TRACE(std::string("compression ") + compression + (summary ? ", summary" : ""));
      ExpectWhole(folder.Write("a.mcap", Mcap(Recording(), compression, summary)));
    }
  }
  const std::string whole = Mcap(Recording(), "-", true);
  const std::string cut = folder.Write("cut.mcap", whole.substr(0, whole.size() * 2 / 3));
  RosRecording recording(OpenRos2Bag(cut), {});
  DropCounts dropped;
  EXPECT_GE(AllEvents(&recording, 640, 480, &dropped).size(), 2U);
  EXPECT_TRUE(dropped.cut_off);
  RosRecording complete(OpenRos2Bag(folder.Write("a.mcap", whole)), {});
  AllEvents(&complete, 640, 480, &dropped);
  EXPECT_FALSE(dropped.cut_off);
  std::string damaged = Mcap(Recording(), "zstd", true);
  damaged[200] ^= 1;
  const std::string path = folder.Write("damaged.mcap", damaged);
  EXPECT_THAT([&] { RosRecording(OpenRos2Bag(path), {}); },
              ThrowsMessage<std::runtime_error>(HasSubstr(path)));
}

TEST(Ros2Recording, PartsOfAFolderAreOneRecording) {
  const TemporaryFolder folder("ros2");
  const std::vector<Message> all = Recording();
  std::filesystem::create_directories(folder.File("bag"));
  WriteSqlite(folder.File("bag/bag_10.db3"), {all.begin() + 3, all.end()});
  WriteSqlite(folder.File("bag/bag_9.db3"), {all.begin(), all.begin() + 3});
  ExpectWhole(folder.File("bag"));
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

// ros2 bag record --compression-mode message
TEST(Ros2Recording, MessagesPackedOneByOneAreRead) {
  const TemporaryFolder folder("ros2");
  std::vector<Message> messages = Recording();
  for (Message& m : messages) m.bytes = ros2::Compress("zstd", m.bytes);
  WriteSqlite(folder.File("a.db3"), messages);
  ExpectWhole(folder.File("a.db3"));
  ExpectWhole(folder.Write("a.mcap", Mcap(messages, "", true)));
  messages[0].bytes.resize(20);
  WriteSqlite(folder.File("b.db3"), messages);
  EXPECT_THAT(
      [&] { RosRecording(OpenRos2Bag(folder.File("b.db3")), {}); },
      ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("b.db3: /cam/events"), HasSubstr("Zstandard"))));
}

TEST(Ros2Recording, APartThatIsListedAndMissingIsNamed) {
  const TemporaryFolder folder("ros2");
  const std::vector<Message> all = Recording();
  std::filesystem::create_directories(folder.File("bag"));
  WriteSqlite(folder.File("bag/bag_0.db3"), {all.begin(), all.begin() + 3});
  WriteSqlite(folder.File("bag/bag_1.db3"), {all.begin() + 3, all.end()});
  // The second was packed as a file, and unpacked beside that.
  folder.Write("bag/metadata.yaml",
               "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths:\n    - bag_0.db3\n"
               "    - \"bag_1.db3.zstd\"\n  duration:\n    nanoseconds: 1\n");
  folder.Write("bag/bag_1.db3.zstd", "packed");
  ExpectWhole(folder.File("bag"));
  std::filesystem::remove(folder.File("bag/bag_1.db3"));
  EXPECT_THAT([&] { OpenRos2Bag(folder.File("bag")); },
              ThrowsMessage<std::runtime_error>(HasSubstr("bag_1.db3.zstd: is compressed as a file")));
  std::filesystem::remove(folder.File("bag/bag_1.db3.zstd"));
  EXPECT_THAT([&] { OpenRos2Bag(folder.File("bag")); },
              ThrowsMessage<std::runtime_error>(HasSubstr("bag_1.db3.zstd: is missing")));
}

}  // namespace
}  // namespace evit::formats
