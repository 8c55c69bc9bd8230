#include "tools/run/pipeline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/bus/memory_bus.h"
#include "tests/helpers/programs.h"

namespace evit::run {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using namespace std::chrono_literals;

class PipelineTest : public ProgramsTest {
 protected:
  static procman::ProcmanCommand Service(const std::string& name, bool replaceable = false) {
    procman::ProcmanCommand command;
    command.id = command.exec = name;
    command.auto_respawn = replaceable;
    return command;
  }
  std::unique_ptr<Pipeline> Make(const std::vector<procman::ProcmanCommand>& services) {
    return std::make_unique<Pipeline>(bus_.get(), "d", services, folder_, folder_);
  }

  std::unique_ptr<Bus> bus_ = OpenMemoryBus(MakeMemoryHub());
};

TEST_F(PipelineTest, StoppedServicesLeaveTheirLogs) {
  Program("a", kWaits);
  Program("b", kWaits);
  const auto pipeline = Make({Service("a"), Service("b")});
  ASSERT_TRUE(Within(5s, [&] {
    pipeline->Watch();
    return Text("a.log") == "here \n" && Text("b.log") == "here \n";
  }));
  pipeline->Stop();
  EXPECT_EQ(Text("a.log"), "here \nbye\n");
  for (const auto& process : pipeline->processes()) EXPECT_TRUE(process->ended_well());
  EXPECT_TRUE(pipeline->deaths().empty());
}

TEST_F(PipelineTest, DeathIsReportedWithTheLastOutput) {
  Program("a", kWaits);
  Program("b", "echo first; echo the disk is on fire >&2; exit 7");
  auto pipeline = Make({Service("a"), Service("b")});
  const pid_t other = pipeline->processes()[0]->pid();
  EXPECT_THAT(
      [&] { Within(5s, [&] { return pipeline->Watch(), false; }); },
      ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("b died with exit code 7"), HasSubstr("on fire"))));
  pipeline.reset();
  EXPECT_TRUE(Gone(other));
}

TEST_F(PipelineTest, DeadServiceIsRestartedAndCounted) {
  Program("map", kWaits);
  const auto pipeline = Make({Service("map", true)});
  const pid_t first = pipeline->processes()[0]->pid();
  for (int kills = 1; kills <= 3; ++kills) {
    ASSERT_TRUE(Within(5s, [&] { return pipeline->Watch(), pipeline->processes()[0]->running(); }));
    kill(pipeline->processes()[0]->pid(), SIGKILL);
    ASSERT_TRUE(Within(5s, [&] { return pipeline->Watch(), pipeline->processes()[0]->runs() == kills + 1; }));
    EXPECT_EQ(pipeline->deaths().size(), static_cast<std::size_t>(kills));
  }
  EXPECT_EQ(pipeline->deaths()[0].service, "map");
  EXPECT_NE(pipeline->processes()[0]->pid(), first);
}

TEST_F(PipelineTest, ServiceThatDiesAtEveryStartIsGivenUp) {
  Program("map", "exit 1");
  const auto pipeline = Make({Service("map", true)});
  EXPECT_THAT([&] { Within(20s, [&] { return pipeline->Watch(), false; }); },
              ThrowsMessage<std::runtime_error>(HasSubstr("map died")));
}

TEST_F(PipelineTest, MissingProgramIsNamed) {
  EXPECT_THAT([&] { Make({Service("none_such")}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("no such program")));
}

}  // namespace
}  // namespace evit::run
