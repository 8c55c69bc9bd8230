#include "procman/managed_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "procman/supervisor.h"
#include "tests/helpers/programs.h"

namespace evit::procman {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using namespace std::chrono_literals;
using State = ManagedProcess::State;

class ManagedProcessTest : public ProgramsTest {
 protected:
  static ProcmanCommand Command(const std::string& exec, bool respawn = false, double patience = 2) {
    ProcmanCommand command;
    command.id = "p";
    command.exec = exec;
    command.auto_respawn = respawn;
    command.stop_time_allowed = patience;
    return command;
  }
  std::unique_ptr<ManagedProcess> Make(const ProcmanCommand& command) {
    return std::make_unique<ManagedProcess>(
        command, ManagedProcess::Places{folder_, folder_},
        [this](const std::string&, const std::string& text) { said_ += text; });
  }
  template <typename Condition>
  static bool TickUntil(ManagedProcess* process, Condition condition) {
    return Within(5s, [&] { return process->Tick(), condition(); });
  }
  bool Said(const std::string& text) const { return said_.find(text) != std::string::npos; }

  std::string said_;
};

TEST_F(ManagedProcessTest, StopEndsItAndKeepsItsLog) {
  Program("a", kWaits);
  const auto p = Make(Command("X=1 a --x \"1 2\""));
  EXPECT_EQ(p->end(), "never started");
  p->Start();
  EXPECT_EQ(p->state(), State::kRunning);
  EXPECT_GT(p->pid(), 0);
  ASSERT_TRUE(TickUntil(p.get(), [&] { return Said("here --x 1 2\n"); }));
  p->Stop();
  EXPECT_EQ(p->state(), State::kStopping);
  ASSERT_TRUE(TickUntil(p.get(), [&] { return p->state() == State::kStopped; }));
  EXPECT_EQ(Text("p.log"), "here --x 1 2\nbye\n");
  EXPECT_TRUE(p->ended_well());
  EXPECT_FALSE(p->died());
  EXPECT_GT(p->peak_mb(), 0);
}

TEST_F(ManagedProcessTest, DeathIsReportedWithTheLastOutput) {
  Program("a", "echo first; echo second; echo the disk is on fire >&2; exit 7");
  const auto p = Make(Command("a"));
  p->Start();
  ASSERT_TRUE(TickUntil(p.get(), [&] { return p->state() == State::kStopped; }));
  EXPECT_TRUE(p->died());
  EXPECT_EQ(p->end(), "exit code 7");
  EXPECT_EQ(p->exit_code(), 7);
  EXPECT_EQ(p->LastWords(2), "\n  second\n  the disk is on fire");
  EXPECT_EQ(p->LastWords(9), "\n  first\n  second\n  the disk is on fire");
  EXPECT_TRUE(Said("ended with exit code 7"));
}

TEST_F(ManagedProcessTest, DeathBySignalIsNamed) {
  Program("a", "kill -SEGV $$");
  const auto p = Make(Command("a"));
  p->Start();
  ASSERT_TRUE(TickUntil(p.get(), [&] { return p->state() == State::kStopped; }));
  EXPECT_THAT(p->end(), HasSubstr("signal 11"));
  EXPECT_EQ(p->exit_code(), 139);
}

TEST_F(ManagedProcessTest, IsStartedAgainWithGrowingDelay) {
  Program("a", "date +%s%N >> starts; exit 1");
  const auto p = Make(Command("env -C " + folder_.string() + " " + folder_.string() + "/a", true));
  p->Start();
  ASSERT_TRUE(TickUntil(p.get(), [&] { return p->runs() == 6; }));
  EXPECT_GE(p->early_deaths(), 5);
  for (const char* delay : {"in 10 ms", "in 20 ms", "in 40 ms", "in 80 ms", "in 160 ms"})
    EXPECT_TRUE(Said(delay));
  p->Stop();
  ASSERT_TRUE(TickUntil(p.get(), [&] { return !p->running(); }));
  const int runs = p->runs();
  std::this_thread::sleep_for(400ms);
  p->Tick();
  EXPECT_EQ(p->runs(), runs);
}

TEST_F(ManagedProcessTest, RestartsWithinMillisecondsAfterAKill) {
  Program("a", kWaits);
  const auto p = Make(Command("a", true));
  p->Start();
  ASSERT_TRUE(TickUntil(p.get(), [&] { return Said("here"); }));
  const pid_t first = p->pid();
  kill(first, SIGKILL);
  ASSERT_TRUE(TickUntil(p.get(), [&] { return p->runs() == 2; }));
  EXPECT_NE(p->pid(), first);
  EXPECT_TRUE(Said("died with signal 9 (Killed); restarting it in 10 ms"));
}

TEST_F(ManagedProcessTest, ProcessThatIgnoresSignalsIsKilled) {
  Program("a", "trap '' INT TERM; echo here; while :; do sleep 0.02; done");
  const auto p = Make(Command("a", true, 0));
  p->Start();
  ASSERT_TRUE(TickUntil(p.get(), [&] { return Said("here"); }));
  p->Stop();
  ASSERT_TRUE(TickUntil(p.get(), [&] { return p->state() == State::kStopped; }));
  EXPECT_THAT(p->end(), HasSubstr("signal 9"));
  EXPECT_TRUE(Said("killing it"));
}

TEST_F(ManagedProcessTest, RestartIsOneNewRun) {
  Program("a", kWaits);
  const auto p = Make(Command("a"));
  p->Start();
  ASSERT_TRUE(TickUntil(p.get(), [&] { return Said("here"); }));
  p->Restart();
  ASSERT_TRUE(TickUntil(p.get(), [&] { return p->runs() == 2 && p->running(); }));
  EXPECT_TRUE(Said("bye"));
  EXPECT_FALSE(p->died());
}

TEST_F(ManagedProcessTest, MissingProgramAndVariableAreNamed) {
  EXPECT_THAT(
      [&] { Make(Command("none_such"))->Start(); },
      ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("no such program as none_such"), HasSubstr("PATH"))));
  EXPECT_THAT([&] { Make(Command("ls ${EVIT_NONE}"))->Start(); },
              ThrowsMessage<std::runtime_error>(HasSubstr("EVIT_NONE")));
}

TEST_F(ManagedProcessTest, ChildrenOfAWrapperAreStopped) {
  Program("a", "sleep 60 & echo $! > child; wait");
  const auto p = Make(Command("env -C " + folder_.string() + " " + folder_.string() + "/a"));
  p->Start();
  ASSERT_TRUE(Within(5s, [&] { return !Text("child").empty(); }));
  const pid_t child = std::stoi(Text("child"));
  p->Stop();
  ASSERT_TRUE(TickUntil(p.get(), [&] { return !p->running(); }));
  EXPECT_TRUE(Within(2s, [&] { return Gone(child); }));
}

TEST_F(ManagedProcessTest, ProcessesDieWithAKilledParent) {
  Program("a", kWaits);
  const std::string pid_file = (folder_ / "pid").string();
  const pid_t parent = fork();
  if (parent == 0) {
    const auto p = Make(Command("a"));
    p->Start();
    std::ofstream(pid_file + ".part") << p->pid();
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

TEST_F(ManagedProcessTest, SupervisorStopsTheLastOneFirstAndWaitsForIt) {
  const std::string order = (folder_ / "order").string();
  for (const char* name : {"a", "b"}) {
    Program(name, std::string("trap 'sleep 0.1; echo ") + name + " >> " + order +
                      "; exit 0' INT; echo here; while :; do sleep 0.02; done");
  }
  ProcmanCommand a = Command("a"), b = Command("b");
  a.id = "a";
  b.id = "b";
  {
    Supervisor supervisor({b, a}, {folder_, folder_}, [](const std::string&, const std::string&) {});
    supervisor.Start("a");
    supervisor.Start("b");
    ASSERT_TRUE(Within(5s, [&] {
      supervisor.Tick();
      return Text("a.log") == "here\n" && Text("b.log") == "here\n";
    }));
  }
  EXPECT_EQ(Text("order"), "b\na\n");
}

}  // namespace
}  // namespace evit::procman
