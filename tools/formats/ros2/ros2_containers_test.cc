// What bags of ROS 2 are packed in: SQLite and MCAP, whole or cut off, in parts, compressed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/helpers/ros2_sample_bag.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::formats {
namespace {

using ros2::Mcap;
using ros2::WriteSqlite;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Ros2Containers, SqliteBagsAreRead) {
  const TemporaryFolder folder("ros2");
  WriteSqlite(folder.File("a.db3"), Recording());
  ExpectWhole(folder.File("a.db3"));
}

// Cut anywhere behind its first messages, such a bag gives what is whole; nearer to its beginning it is
// refused.
TEST(Ros2Containers, OfASqliteBagThatIsCutOffTheBeginningIsRead) {
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

TEST(Ros2Containers, McapFilesAreReadPlainAndInChunks) {
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

TEST(Ros2Containers, PartsOfAFolderAreOneRecording) {
  const TemporaryFolder folder("ros2");
  const std::vector<Message> all = Recording();
  std::filesystem::create_directories(folder.File("bag"));
  WriteSqlite(folder.File("bag/bag_10.db3"), {all.begin() + 3, all.end()});
  WriteSqlite(folder.File("bag/bag_9.db3"), {all.begin(), all.begin() + 3});
  ExpectWhole(folder.File("bag"));
}

// ros2 bag record --compression-mode message
TEST(Ros2Containers, MessagesPackedOneByOneAreRead) {
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

TEST(Ros2Containers, APartThatIsListedAndMissingIsNamed) {
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
