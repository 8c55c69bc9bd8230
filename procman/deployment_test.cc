#include "procman/deployment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "tests/helpers/paths.h"

namespace evit::procman {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr char kBoth[] = R"(
# a comment
cmd "a" { exec = "prog -x \"1 2\""; deputy = "here"; }
group "g" {
  cmd "b" {
    exec = "other";   # bot-procman's spelling
    host = "there";
    auto_respawn = "true";
    stop_signal = 15;
    stop_time_allowed = 20;
  }
  group "inner" { cmd "c" { exec = "c"; host = "here"; } }
}
script "go" {
  start cmd "a" wait "stopped";
  wait ms 500;
  start group "g" wait "running";
  run_script "end";
}
script "end" {
  stop group "g/inner";
  restart cmd "b";
  wait cmd "a" status "stopped";
}
)";

Deployment Parse(const std::string& text) { return ParseDeployment(text, "f.procman"); }

TEST(DeploymentTest, ReadsBothDialects) {
  const Deployment d = Parse(kBoth);
  ASSERT_EQ(d.commands.size(), 3U);
  EXPECT_EQ(d.Find("a")->exec, "prog -x \"1 2\"");
  EXPECT_EQ(d.Find("a")->deputy, "here");
  EXPECT_FALSE(d.Find("a")->auto_respawn);
  EXPECT_EQ(d.Find("a")->stop_signal, 2);
  EXPECT_EQ(d.Find("a")->stop_time_allowed, 7);
  const ProcmanCommand& b = *d.Find("b");
  EXPECT_EQ(b.deputy, "there");
  EXPECT_EQ(b.group, "g");
  EXPECT_TRUE(b.auto_respawn);
  EXPECT_EQ(b.stop_signal, 15);
  EXPECT_EQ(b.stop_time_allowed, 20);
  EXPECT_EQ(d.Find("c")->group, "g/inner");
  EXPECT_EQ(d.Find("d"), nullptr);
}

TEST(DeploymentTest, ReadsScripts) {
  const Deployment d = Parse(kBoth);
  const ProcmanScript& go = *d.FindScript("go");
  ASSERT_EQ(go.steps.size(), 4U);
  EXPECT_EQ(go.steps[0].kind, ScriptStep::Kind::kStart);
  EXPECT_EQ(go.steps[0].wait, "stopped");
  EXPECT_EQ(go.steps[1].wait_ms, 500);
  EXPECT_TRUE(go.steps[2].whole_group);
  EXPECT_THAT(d.Targets(go.steps[2]), ElementsAre("b", "c"));
  EXPECT_EQ(go.steps[3].target, "end");
  const ProcmanScript& end = *d.FindScript("end");
  EXPECT_THAT(d.Targets(end.steps[0]), ElementsAre("c"));
  EXPECT_EQ(end.steps[1].kind, ScriptStep::Kind::kRestart);
  EXPECT_EQ(end.steps[2].kind, ScriptStep::Kind::kWaitStatus);
}

struct Bad {
  const char* text;
  const char* says;
};

TEST(DeploymentTest, ErrorsNameFileLineAndRemedy) {
  const Bad cases[] = {
      {"cmd \"a\" {\n  exec = \"x\";\n}", "f.procman:1: command \"a\" has no deputy"},
      {"cmd \"a\" { deputy = \"x\"; }", "has no exec"},
      {"\ncmd a { }", "f.procman:2: the command's id in quotes is expected, not a"},
      {"cmd \"a\" { exec = \"x\"; host = \"h\" }", "';' is expected, not }"},
      {"cmd \"a\" { exe = \"x\"; }", "unknown attribute \"exe\"; known: exec"},
      {"cmd \"a\" { exec = \"x", "not closed"},
      {"cmd \"a\" { exec = \"x\"; host = \"h\"; stop_signal = 99; }", "1..64 is expected, not 99"},
      {"cmd \"a\" { exec = \"x\"; host = \"h\"; auto_respawn = \"yes\"; }", "\"true\" or \"false\""},
      {"cmd \"a\" { exec=\"x\"; host=\"h\"; } cmd \"a\" { exec=\"x\"; host=\"h\"; }", "already"},
      {"group \"a/b\" { }", "has no /"},
      {"group \"a\" {", "cmd, group or script is expected, not the end of the file"},
      {"script \"s\" { start cmd \"none\"; }", "command \"none\", which does not exist"},
      {"script \"s\" { stop group \"none\"; }", "group \"none\", which does not exist"},
      {"script \"s\" { run_script \"t\"; } script \"t\" { run_script \"s\"; }", "runs itself"},
      {"script \"s\" { wait ms 99999999999; }", "is expected, not 99999999999"},
      {"script \"s\" { jump; }", "is expected, not jump"},
      {"@", "unexpected character '@'"},
  };
  for (const Bad& bad : cases) {
    EXPECT_THAT([&] { Parse(bad.text); }, ThrowsMessage<std::runtime_error>(HasSubstr(bad.says))) << bad.text;
  }
  EXPECT_THAT([] { LoadDeployment("/none.procman"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("/none.procman")));
}

TEST(DeploymentTest, DeepNestingIsRefusedNotFatal) {
  std::string text;
  for (int k = 0; k < 100'000; ++k) text += "group \"g\" {";
  EXPECT_THAT([&] { Parse(text); }, ThrowsMessage<std::runtime_error>(HasSubstr("too deep")));
}

// All that a deployment says, to compare two.
auto Commands(const Deployment& d) {
  std::vector<std::tuple<std::string, std::string, std::string, std::string, bool, int, double>> all;
  for (const ProcmanCommand& c : d.commands) {
    all.emplace_back(c.id, c.exec, c.deputy, c.group, c.auto_respawn, c.stop_signal, c.stop_time_allowed);
  }
  return all;
}

auto Steps(const Deployment& d) {
  std::vector<std::tuple<std::string, ScriptStep::Kind, bool, std::string, std::string, int>> all;
  for (const ProcmanScript& script : d.scripts) {
    for (const ScriptStep& s : script.steps) {
      all.emplace_back(script.name, s.kind, s.whole_group, s.target, s.wait, s.wait_ms);
    }
  }
  return all;
}

TEST(DeploymentTest, ShippedDialectsAgree) {
  const std::string folder = test::SourcePath("procman/");
  const Deployment procman = LoadDeployment(folder + "evit.procman");
  const Deployment bot_procman = LoadDeployment(folder + "evit.pmd");
  EXPECT_EQ(Commands(bot_procman), Commands(procman));
  EXPECT_EQ(Steps(bot_procman), Steps(procman));
}

TEST(DeploymentTest, ShippedServicesRestart) {
  const Deployment shipped = LoadDeployment(test::SourcePath("procman/evit.procman"));
  for (const char* service : {"map_server", "window_optimizer", "frame_builder", "log_replay"}) {
    ASSERT_NE(shipped.Find(service), nullptr) << service;
    EXPECT_TRUE(shipped.Find(service)->auto_respawn);
  }
}

}  // namespace
}  // namespace evit::procman
