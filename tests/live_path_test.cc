// A live camera as a newcomer starts it: `evit up` in one shell, `evit feed` in another. Runs in a network
// namespace of its own, in which `lo` carries multicast.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>

#include "tests/helpers/child_process.h"
#include "tests/helpers/paths.h"
#include "tests/helpers/programs.h"
#include "tests/helpers/run_evit.h"
#include "tests/helpers/temporary_folder.h"

namespace evit {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kLogs = test::SourcePath("logs/");
const std::string kBus = "udpm://239.255.76.67:7699?ttl=0";
constexpr auto kPatience = std::chrono::seconds(60);

class LivePathTest : public ::testing::Test {
 protected:
  LivePathTest() {
    setenv("XDG_RUNTIME_DIR", folder_.File("").c_str(),
           1);  // what others find a pipeline by is the test's own
    setenv("EVIT_MAP", (kLogs + "sample_map.pcd").c_str(), 1);
    setenv("EVIT_RIG", (kLogs + "rig.textproto").c_str(), 1);
    setenv("EVIT_START", "", 1);
    unsetenv("LCM_DEFAULT_URL");
  }
  ~LivePathTest() override {
    if (!up_) return;
    up_->Signal(SIGINT);
    up_->Wait(kPatience);
  }

  /// `evit up` of the robot's script, until its services are there.
  void StartUp(const std::string& around, const std::string& bus) {
    up_ = std::make_unique<ChildProcess>(
        std::vector<std::string>{"/bin/sh", "-c",
                                 (bus.empty() ? "" : "LCM_DEFAULT_URL='" + bus + "' ") + "exec " + around +
                                     test::ProgramPath("evit") + " up evit.procman robot --logs " +
                                     folder_.File("logs") + " >" + folder_.File("up.txt")},
        folder_.File("up.err"));
    EXPECT_TRUE(Within(kPatience, [&] { return Said("up.txt", "has run"); })) << up_->Stderr();
  }
  bool Said(const std::string& file, const std::string& words) const {
    return Text(file).find(words) != std::string::npos;
  }
  std::string Text(const std::string& name) const {
    std::ifstream file(folder_.File(name));
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  static test::ProgramOutcome Feed() {
    return test::RunEvit("feed --from " + kLogs + "sample.lcmlog --realtime");
  }

  TemporaryFolder folder_{"live_path"};
  std::unique_ptr<ChildProcess> up_;
};

// unshare: a host without a multicast route, where `evit up` makes a network of its own.
TEST_F(LivePathTest, FeedReachesAPipelineInANetworkOfItsOwn) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the thread sanitizer's own thread keeps a process from joining a namespace";
#endif
  StartUp("unshare -rn ", "");
  EXPECT_THAT(Text("up.txt"), HasSubstr("export LCM_DEFAULT_URL='udpm://"));
  const test::ProgramOutcome feed = Feed();
  EXPECT_EQ(feed.code, 0) << feed.output;
  EXPECT_THAT(feed.output, Not(HasSubstr("no frame_builder")));
  EXPECT_TRUE(Within(kPatience, [&] { return Said("up.txt", "frame_builder: running"); })) << Text("up.txt");
}

TEST_F(LivePathTest, FeedSaysThatNobodyListens) {
  const test::ProgramOutcome feed = Feed();
  EXPECT_EQ(feed.code, 0) << feed.output;
  EXPECT_THAT(feed.output, HasSubstr("no frame_builder is heard"));
  EXPECT_THAT(feed.output, HasSubstr("evit up evit.procman robot"));
}

TEST_F(LivePathTest, FeedRefusesAPipelineThatPlaysALog) {
  setenv("EVIT_LOG", (kLogs + "sample.lcmlog").c_str(), 1);
  up_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{"/bin/sh", "-c",
                               "exec " + test::ProgramPath("evit") + " run --realtime --speed 0.2 --log " +
                                   kLogs + "sample.lcmlog --map $EVIT_MAP --rig $EVIT_RIG --initial-from " +
                                   kLogs + "sample_truth.tum --out " + folder_.File("out")},
      folder_.File("run.err"));
  EXPECT_TRUE(Within(kPatience, [] {
    const std::string ps = test::RunEvit("ps").output;
    return ps.find("log_replay           running") != std::string::npos;
  }));
  const test::ProgramOutcome feed = Feed();
  EXPECT_EQ(feed.code, 1) << feed.output;
  EXPECT_THAT(feed.output, HasSubstr("evit stop log_replay"));
}

TEST_F(LivePathTest, LogsOfAPipelineOnANamedBusAreFound) {
  StartUp("", kBus);
  setenv("LCM_DEFAULT_URL", kBus.c_str(), 1);
  EXPECT_TRUE(Within(kPatience, [&] { return Said("logs/window_optimizer.log", "\n"); }));
  const test::ProgramOutcome logs = test::RunEvit("logs window_optimizer -n 5");
  EXPECT_EQ(logs.code, 0) << logs.output;
  EXPECT_THAT(logs.output, HasSubstr("window_optimizer: "));
  const test::ProgramOutcome wrong = test::RunEvit("logs windows");
  EXPECT_EQ(wrong.code, 1);
  EXPECT_THAT(wrong.output, HasSubstr("there is no command \"windows\""));
}

TEST_F(LivePathTest, UpStartsNothingWithoutTheFilesThatTheEnvironmentNames) {
  const auto up = [&] { return test::RunEvit("up evit.procman robot --logs " + folder_.File("logs")); };
  setenv("EVIT_MAP", "nomap.pcd", 1);
  EXPECT_THAT(up().output, HasSubstr("EVIT_MAP=nomap.pcd: there is no such file"));
  setenv("EVIT_MAP", kLogs.c_str(), 1);
  EXPECT_THAT(up().output, HasSubstr("is a folder"));
  setenv("EVIT_MAP", "", 1);
  EXPECT_THAT(up().output, HasSubstr("EVIT_MAP is empty"));
  unsetenv("EVIT_MAP");
  const test::ProgramOutcome unset = up();
  EXPECT_EQ(unset.code, 1);
  EXPECT_THAT(unset.output, HasSubstr("EVIT_MAP, which is not set"));
  EXPECT_THAT(unset.output, Not(HasSubstr("running")));
}

}  // namespace
}  // namespace evit
