#include "tools/run/bus_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "common/bus/memory_bus.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::run {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

class BusLogTest : public ::testing::Test {
 protected:
  void Send(const std::string& channel, std::size_t size) {
    const std::vector<std::uint8_t> data(size, 7);
    sender_->Publish(channel, data.data(), data.size());
    receiver_->Poll(0);
  }
  std::string Path() const { return folder_.File("run.lcmlog"); }
  bool NothingThere() const { return fs::is_empty(fs::path(Path()).parent_path()); }

  TemporaryFolder folder_{"bus_log"};
  std::shared_ptr<MemoryHub> hub_ = MakeMemoryHub();
  std::unique_ptr<Bus> sender_ = OpenMemoryBus(hub_), receiver_ = OpenMemoryBus(hub_);
};

TEST_F(BusLogTest, KeepsWhatComesOnItsChannels) {
  BusLog log(receiver_.get(), Path(), {"A", "B"});
  Send("B", 10);
  Send("C", 10);
  Send("A", 20);
  EXPECT_FALSE(fs::exists(Path()));  // until it is whole
  log.Close();
  const LogReader reader(Path());
  EXPECT_THAT(reader.channels(), ElementsAre("B", "A"));
  EXPECT_EQ(reader.entries().back().size, 20);
  EXPECT_EQ(reader.trailing_bytes(), 0);
}

TEST_F(BusLogTest, ARunThatFailsKeepsWhatItHad) {
  {
    const BusLog log(receiver_.get(), Path(), {"A"});
    Send("A", 10);
  }
  EXPECT_EQ(LogReader(Path()).entries().size(), 1U);
}

// A file may not grow beyond so many bytes: as on a full disk. In a process of its own, down to its exit.
TEST_F(BusLogTest, AFullDiskLeavesNothingOfTheLogAndIsReportedAtTheEnd) {
  const auto fill = [&] {
    const rlimit limit = {100'000, 100'000};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
    BusLog log(receiver_.get(), Path(), {"A"});
    for (int k = 0; k < 30; ++k) Send("A", 10'000);
    if (!NothingThere()) std::exit(3);
    try {
      log.Close();
    } catch (const std::runtime_error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      std::exit(NothingThere() ? 2 : 4);
    }
    std::exit(5);
  };
  EXPECT_EXIT(fill(), ::testing::ExitedWithCode(2), "--record .*run.lcmlog: .*make room");
}

}  // namespace
}  // namespace evit::run
