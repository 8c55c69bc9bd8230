// The real program over real UDP multicast, in a network namespace of the test's own.
#include <gmock/gmock.h>
#include <signal.h>

#include "common/bus/lcm_bus.h"
#include "common/map/denoise.h"
#include "common/map/map_file.h"
#include "tests/helpers/child_process.h"
#include "tests/helpers/map_asker.h"
#include "tests/helpers/map_files.h"
#include "tests/helpers/paths.h"

namespace evit {
namespace {

using Clock = std::chrono::steady_clock;
using ::testing::HasSubstr;
const std::string kProgram = test::ProgramPath("map_server");
constexpr char kUrl[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

class MapServerBusTest : public ::testing::Test {
 protected:
  MapServerBusTest() : map_(test::Room(200'000, {3, 2.5F, 1.4F}, 1)), file_("", "room.pcd") {
    WritePcd(file_.path(), map_);
    Denoise(DenoiseSettingsFor(map_, Summarize(map_).median_spacing), &map_);  // as the server does
  }
  static std::vector<std::string> Command(const std::string& map) {
    return {kProgram, "--map", map, "--lcm-url", kUrl};
  }
  static std::string StderrFile() {
    return ::testing::TempDir() + "map_server_" + std::to_string(::getpid());
  }

  template <typename Condition>
  bool PollUntil(const Condition& holds) {
    const auto end = Clock::now() + std::chrono::seconds(60);
    while (!holds()) {
      if (Clock::now() > end) return false;
      bus_->Poll(5);
    }
    return true;
  }
  // Asks again every 100 ms until this query is answered, as window_optimizer does.
  bool Ask(std::int64_t seq) {
    auto asked = Clock::time_point();
    return PollUntil([&] {
      if (Clock::now() - asked > std::chrono::milliseconds(100)) {
        asker_.Send(test::QueryMessage(seq));
        asked = Clock::now();
      }
      return !asker_.answers.empty() && asker_.answers.back().query_seq == seq;
    });
  }

  PointMap map_;
  test::TemporaryFile file_;
  std::unique_ptr<Bus> bus_ = OpenLcmBus(kUrl);
  test::Asker asker_{bus_.get()};
};

TEST_F(MapServerBusTest, AnswersAmidRubbishAndEndsOnSigterm) {
  ChildProcess server(Command(file_.path()), StderrFile());
  ASSERT_TRUE(PollUntil([&] { return asker_.state == "running"; }));
  EXPECT_THAT(asker_.detail, HasSubstr("200000 points (PCD binary), 6.0 x 5.0 x 2.8 m"));
  const std::size_t n_bad = test::AbsurdQueries().size();
  for (const auto& bad : test::AbsurdQueries()) asker_.Send(bad.second);
  asker_.SendRaw({1, 2, 3});
  ASSERT_TRUE(Ask(1));
  EXPECT_EQ(asker_.answers.back().id, MapIndex(map_).Query(test::LibraryQuery()).ids);
  ASSERT_TRUE(PollUntil([&] { return asker_.counters["MAP_QUERY.received"] > 0; }));
  EXPECT_EQ(asker_.counters["MAP_QUERY.invalid"], static_cast<std::int64_t>(n_bad) + 1);
  EXPECT_EQ(asker_.counters["map.points"], 200'000);

  server.Signal(SIGTERM);
  EXPECT_EQ(server.Wait(std::chrono::seconds(60)), 0);
  EXPECT_TRUE(PollUntil([&] { return asker_.state == "finished"; }));
}

TEST_F(MapServerBusTest, KilledAndStartedAgainItAnswersTheNextQueryAlike) {
  std::vector<std::int32_t> ids;
  std::int64_t epoch = 0;
  {
    ChildProcess server(Command(file_.path()), StderrFile());
    ASSERT_TRUE(Ask(1));
    ids = asker_.answers.back().id;
    epoch = asker_.answers.back().epoch;
    server.Signal(SIGKILL);
    EXPECT_EQ(server.Wait(std::chrono::seconds(60)), -2);
  }
  asker_.Send(test::QueryMessage(2));  // into the void
  ChildProcess server(Command(file_.path()), StderrFile());
  ASSERT_TRUE(Ask(3));
  EXPECT_EQ(asker_.answers.back().id, ids);
  EXPECT_NE(asker_.answers.back().epoch, epoch);
  server.Signal(SIGINT);
  EXPECT_EQ(server.Wait(std::chrono::seconds(60)), 0);
}

TEST_F(MapServerBusTest, RefusesMapsItCannotServe) {
  const auto fails = [&](const std::string& map) {
    ChildProcess server(Command(map), StderrFile());
    EXPECT_EQ(server.Wait(std::chrono::seconds(60)), 1) << map;
    return server.Stderr();
  };
  EXPECT_THAT(fails("/nowhere/map.pcd"), HasSubstr("/nowhere/map.pcd: cannot be read"));
  EXPECT_THAT(fails(test::TemporaryFile("# x y z\n", "empty.txt").path()), HasSubstr("the map is empty"));
  std::string millimetres;
  for (int k = 0; k < 1000; ++k) {
    millimetres += std::to_string(k % 10 * 7) + " " + std::to_string(k / 10 % 10 * 7) + " " +
                   std::to_string(k / 100 * 7) + "\n";
  }
  EXPECT_THAT(fails(test::TemporaryFile(millimetres, "mm.txt").path()), HasSubstr("millimetres"));
}

}  // namespace
}  // namespace evit
