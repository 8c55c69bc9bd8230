#include "tools/run/pipeline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

namespace evit {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using namespace std::chrono_literals;

template <typename Condition>
bool Within(std::chrono::milliseconds longest, Condition condition) {
  const auto end = std::chrono::steady_clock::now() + longest;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

// Gone, or ended and not yet reaped by whoever adopted it.
bool Gone(pid_t pid) {
  if (kill(pid, 0) != 0) return true;
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string id, name, state;
  file >> id >> name >> state;
  return state == "Z" || state.empty();
}

// Programs are shell scripts in a folder of the test's own.
class PipelineTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) / ("pipeline_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void Program(const std::string& name, const std::string& body) const {
    std::ofstream(folder_ / name) << "#!/bin/sh\n" << body << '\n';
    chmod((folder_ / name).c_str(), 0700);
  }
  bool Exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  std::string Text(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  std::filesystem::path folder_;
};

constexpr char kWaits[] = "trap 'echo bye; exit 0' INT; echo \"here $*\"; while :; do sleep 0.02; done";

TEST_F(PipelineTest, ChildrenRunAreToldToStopAndLeaveLogs) {
  Program("a", kWaits);
  Program("b", kWaits);
  Pipeline pipeline({{"a", {"--x", "1 2"}}, {"b", {}}}, folder_, folder_);
  ASSERT_TRUE(Within(5s, [&] { return Text("a.log") == "here --x 1 2\n" && Text("b.log") == "here \n"; }));
  pipeline.Watch();
  pipeline.Stop();
  EXPECT_EQ(Text("a.log"), "here --x 1 2\nbye\n");
  for (const auto& child : pipeline.children()) {
    EXPECT_TRUE(child->ended_well());
    EXPECT_GT(child->peak_mb(), 0);
  }
}

TEST_F(PipelineTest, DeathIsReportedWithLastWordsAndTheOthersStop) {
  Program("a", kWaits);
  Program("b", "echo first; echo the disk is on fire >&2; exit 7");
  pid_t other = 0;
  {
    Pipeline pipeline({{"a", {}}, {"b", {}}}, folder_, folder_);
    other = pipeline.children()[0]->pid();
    EXPECT_THAT(
        [&] { Within(5s, [&] { return pipeline.Watch(), false; }); },
        ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("b died with exit code 7"), HasSubstr("on fire"))));
  }
  EXPECT_TRUE(Gone(other));
}

TEST_F(PipelineTest, DeathBySignalIsNamed) {
  Program("a", "kill -SEGV $$");
  Pipeline pipeline({{"a", {}}}, folder_, folder_);
  EXPECT_THAT([&] { Within(5s, [&] { return pipeline.Watch(), false; }); },
              ThrowsMessage<std::runtime_error>(HasSubstr("signal 11")));
}

TEST_F(PipelineTest, ReplaceableServiceIsStartedAgain) {
  Program("map", kWaits);
  Pipeline pipeline({{"map", {}, true}}, folder_, folder_);
  const pid_t first = pipeline.children()[0]->pid();
  ASSERT_TRUE(Within(5s, [&] { return Text("map.log") == "here \n"; }));
  kill(first, SIGKILL);
  ASSERT_TRUE(Within(5s, [&] { return pipeline.Watch(), pipeline.restarts() == 1; }));
  EXPECT_NE(pipeline.children()[0]->pid(), first);
  EXPECT_TRUE(Within(5s, [&] { return Text("map.log") == "here \nhere \n"; }));
}

TEST_F(PipelineTest, ReplaceableServiceThatNeverLivesIsGivenUp) {
  Program("map", "exit 1");
  Pipeline pipeline({{"map", {}, true}}, folder_, folder_);
  EXPECT_THAT([&] { Within(20s, [&] { return pipeline.Watch(), false; }); },
              ThrowsMessage<std::runtime_error>(HasSubstr("map died")));
}

TEST_F(PipelineTest, StubbornChildIsKilled) {
  Program("a", "trap '' INT TERM; echo here; while :; do sleep 0.02; done");
  Pipeline pipeline({{"a", {}}}, folder_, folder_);
  ASSERT_TRUE(Within(5s, [&] { return Text("a.log") == "here\n"; }));
  pipeline.children()[0]->Stop(100);
  EXPECT_FALSE(pipeline.children()[0]->Running());
  EXPECT_THAT(pipeline.children()[0]->end(), HasSubstr("signal 9"));
}

TEST_F(PipelineTest, MissingProgramIsNamed) {
  EXPECT_THAT(
      [&] {
        Pipeline pipeline({{"none", {}}}, folder_, folder_);
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("there is no such program")));
}

TEST_F(PipelineTest, NoChildOutlivesAKilledParent) {
  Program("a", kWaits);
  const std::string pid_file = (folder_ / "pid").string();
  const pid_t parent = fork();
  if (parent == 0) {
    Pipeline pipeline({{"a", {}}}, folder_, folder_);
    std::ofstream(pid_file + ".part") << pipeline.children()[0]->pid();
    std::filesystem::rename(pid_file + ".part", pid_file);
    pause();
    _exit(0);
  }
  ASSERT_TRUE(Within(5s, [&] { return Exists("pid"); }));
  const pid_t child = std::stoi(Text("pid"));
  EXPECT_FALSE(Gone(child));
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  EXPECT_TRUE(Within(2s, [&] { return Gone(child); }));
}

}  // namespace
}  // namespace evit
