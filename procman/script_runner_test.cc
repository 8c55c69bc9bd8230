#include "procman/script_runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/helpers/programs.h"

namespace evit::procman {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using namespace std::chrono_literals;

class ScriptRunnerTest : public ProgramsTest {};

TEST_F(ScriptRunnerTest, RunsStepsInOrderAndWaits) {
  Program("once", "sleep 0.1; echo once >> " + (folder_ / "trace").string());
  Program("stays", "echo stays >> " + (folder_ / "trace").string() + "; " + kWaits);
  const Deployment deployment = ParseDeployment(R"(
    cmd "once" { exec = "once"; deputy = "d"; }
    group "g" { cmd "stays" { exec = "stays"; deputy = "d"; } }
    cmd "elsewhere" { exec = "none"; deputy = "other"; }
    script "go" { start cmd "once" wait "stopped"; start cmd "elsewhere" wait "running"; run_script "rest"; }
    script "rest" { start group "g" wait "running"; wait ms 100; stop cmd "stays" wait "stopped"; })",
                                                "f");
  Supervisor supervisor({*deployment.Find("once"), *deployment.Find("stays")}, {folder_, folder_},
                        [](const std::string&, const std::string&) {});
  ScriptRunner runner(deployment, &supervisor);
  EXPECT_TRUE(runner.done());
  runner.Run("go");
  const auto begin = std::chrono::steady_clock::now();
  runner.Tick();
  EXPECT_FALSE(runner.done());
  ASSERT_TRUE(Within(10s, [&] {
    supervisor.Tick();
    runner.Tick();
    return runner.done();
  }));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 200ms);
  EXPECT_EQ(Text("trace"), "once\nstays\n");
  EXPECT_FALSE(supervisor.Find("stays")->running());
  EXPECT_THAT([&] { runner.Run("none"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("there are: go, rest")));
}

}  // namespace
}  // namespace evit::procman
