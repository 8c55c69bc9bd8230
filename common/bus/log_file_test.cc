#include "common/bus/log_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <string>

#include "common/bus/log_bus.h"

namespace evit {
namespace {

class LogFileTest : public ::testing::Test {
 protected:
  LogFileTest() : path_(::testing::TempDir() + "log_file_test.lcmlog") {}
  ~LogFileTest() override { std::filesystem::remove(path_); }

  void WriteThree() const {
    LogWriter writer(path_);
    writer.Write(100, "EVENTS", "abc", 3);
    writer.Write(200, "IMU", "", 0);
    writer.Write(-5, "EVENTS", "defgh", 5);
    writer.Close();
  }
  std::string OpenError() const {
    try {
      const LogReader reader(path_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  std::string path_;
};

TEST_F(LogFileTest, ReadsWhatItWrote) {
  WriteThree();
  const LogReader reader(path_);
  ASSERT_EQ(reader.entries().size(), 3U);
  EXPECT_EQ(reader.trailing_bytes(), 0);
  EXPECT_EQ(reader.channels(), (std::vector<std::string>{"EVENTS", "IMU"}));
  EXPECT_EQ(reader.entries()[2].utime, -5);
  std::vector<std::uint8_t> data;
  reader.Read(reader.entries()[2], &data);
  EXPECT_EQ(std::string(data.begin(), data.end()), "defgh");
  reader.Read(reader.entries()[1], &data);
  EXPECT_TRUE(data.empty());
}

TEST_F(LogFileTest, LcmReadsWhatItWrote) {
  WriteThree();
  lcm::LogFile log(path_, "r");
  ASSERT_TRUE(log.good());
  const lcm::LogEvent* event = log.readNextEvent();
  ASSERT_NE(event, nullptr);
  EXPECT_EQ(event->channel, "EVENTS");
  EXPECT_EQ(event->timestamp, 100);
  EXPECT_EQ(std::string(static_cast<char*>(event->data), event->datalen), "abc");
  ASSERT_NE(log.readNextEvent(), nullptr);
  ASSERT_NE(log.readNextEvent(), nullptr);
  EXPECT_EQ(log.readNextEvent(), nullptr);
}

TEST_F(LogFileTest, ReadsWhatLcmWrote) {
  {
    lcm::LogFile log(path_, "w");
    char data[] = "xyz";
    lcm::LogEvent event{};
    event.timestamp = 42;
    event.channel = "POSE";
    event.data = data;
    event.datalen = 3;
    log.writeEvent(&event);
  }
  const LogReader reader(path_);
  ASSERT_EQ(reader.entries().size(), 1U);
  EXPECT_EQ(reader.channel(reader.entries()[0]), "POSE");
  EXPECT_EQ(reader.entries()[0].utime, 42);
}

TEST_F(LogFileTest, ACutFileEndsAtItsLastWholeMessageAndSaysSo) {
  WriteThree();
  const auto whole = std::filesystem::file_size(path_);
  for (std::uintmax_t size = whole - 1; size > 28 + 6 + 3; --size) {
    std::filesystem::resize_file(path_, size);
    const LogReader reader(path_);
    EXPECT_LT(reader.entries().size(), 3U);
    EXPECT_EQ(reader.trailing_bytes() == 0, size == (28 + 6 + 3) + (28 + 3)) << size;
  }
}

TEST_F(LogFileTest, AForgedLengthIsNotBelieved) {
  WriteThree();
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(24);
  file.write("\x7F\xFF\xFF\xFF", 4);
  file.close();
  EXPECT_NE(OpenError().find("no whole LCM message"), std::string::npos);
}

TEST_F(LogFileTest, BadFilesAreNamed) {
  EXPECT_NE(OpenError().find(path_), std::string::npos);
  std::ofstream(path_).close();
  EXPECT_NE(OpenError().find("is empty"), std::string::npos);
  std::ofstream(path_) << "timestamp x y p\n1 2 3 0\n1 2 3 0\n";
  EXPECT_NE(OpenError().find("no whole LCM message"), std::string::npos);
  EXPECT_THROW(LogReader{::testing::TempDir()}, std::runtime_error);
  EXPECT_THROW(LogWriter{"/no/such/folder/x.lcmlog"}, std::runtime_error);
}

TEST_F(LogFileTest, AFullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  LogWriter writer("/dev/full");
  const std::vector<std::uint8_t> big(1 << 20);
  EXPECT_THROW(
      {
        writer.Write(0, "EVENTS", big.data(), big.size());
        writer.Close();
      },
      std::runtime_error);
}

TEST_F(LogFileTest, ALogIsABus) {
  WriteThree();
  const std::string sink = path_ + ".out";
  {
    const std::unique_ptr<Bus> bus = OpenLogBus(path_, sink);
    bus->Subscribe("EVENTS", [&](const std::string&, const std::uint8_t* data, std::size_t size) {
      bus->Publish("COPY", data, size);
    });
    EXPECT_EQ(bus->Poll(0), 1);
    EXPECT_EQ(bus->Poll(0), 1);
    EXPECT_EQ(bus->Poll(0), 0);
  }
  const LogReader copy(sink);
  ASSERT_EQ(copy.entries().size(), 2U);
  EXPECT_EQ(copy.entries()[0].utime, 100);
  EXPECT_EQ(copy.entries()[1].utime, -5);
  EXPECT_EQ(copy.entries()[1].size, 5);
  std::filesystem::remove(sink);
}

}  // namespace
}  // namespace evit
