#include "procman/deputy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/bus/memory_bus.h"
#include "procman/sheriff.h"
#include "tests/helpers/programs.h"

namespace evit::procman {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using namespace std::chrono_literals;

// Deputy and sheriff on two ends of a bus in memory; the sheriff's polls let the deputy work.
class DeputyTest : public ProgramsTest {
 protected:
  void SetUp() override {
    ProgramsTest::SetUp();
    Program("a", kWaits);
    Program("talks",
            "i=0; while [ $i -lt 3000 ]; do echo 'a line of fifty characters, nothing more than that..'; "
            "i=$((i+1)); done; exec sleep 60");
    hub_ = MakeMemoryHub();
    deputy_bus_ = OpenMemoryBus(hub_);
    bus_ = OpenMemoryBus(hub_);
    std::vector<ProcmanCommand> commands(2);
    commands[0].id = commands[0].exec = "a";
    commands[0].group = "g";
    commands[1].id = commands[1].exec = "talks";
    deputy_ =
        std::make_unique<Deputy>(deputy_bus_.get(), "d", commands, ManagedProcess::Places{folder_, folder_});
    bus_->Subscribe(kPmInfo, [this](const std::string&, const std::uint8_t* data, std::size_t size) {
      std::string why;
      ASSERT_TRUE(DecodeProcman(data, size, &info_, &why)) << why;
      ++n_infos_;
    });
    bus_->Subscribe(kPmOutput, [this](const std::string&, const std::uint8_t* data, std::size_t size) {
      procman_lcm::output_t output;
      std::string why;
      ASSERT_TRUE(DecodeProcman(data, size, &output, &why)) << why;
      said_[output.command_id] += output.text;
    });
  }
  void TearDown() override {
    deputy_.reset();
    ProgramsTest::TearDown();
  }

  void Step() {
    deputy_bus_->Poll(0);
    deputy_->Tick();
    bus_->Poll(0);
  }
  template <typename Condition>
  bool StepUntil(Condition condition) {
    return Within(5s, [&] { return Step(), condition(); });
  }
  void Order(const std::string& command, int runid, bool quit, const std::string& deputy = "d") {
    procman_lcm::orders_t orders;
    orders.utime = 0;
    orders.deputy_id = deputy;
    orders.sheriff_id = "test";
    orders.ncmds = 1;
    orders.cmds.resize(1);
    orders.cmds[0].cmd.command_id = command;
    orders.cmds[0].cmd.exec_str = "touch /tmp/evit_from_the_bus";
    orders.cmds[0].cmd.auto_respawn = 0;
    orders.cmds[0].cmd.stop_signal = 9;
    orders.cmds[0].cmd.stop_time_allowed = 0;
    orders.cmds[0].desired_runid = runid;
    orders.cmds[0].force_quit = quit ? 1 : 0;
    const auto bytes = EncodeProcman(orders);
    bus_->Publish(kPmOrders, bytes.data(), bytes.size());
  }

  std::shared_ptr<MemoryHub> hub_;
  std::unique_ptr<Bus> deputy_bus_, bus_;
  std::unique_ptr<Deputy> deputy_;
  procman_lcm::deputy_info_t info_;
  int n_infos_ = 0;
  std::map<std::string, std::string> said_;
};

TEST_F(DeputyTest, PublishesInfoAndOutput) {
  deputy_->supervisor().Start("a");
  ASSERT_TRUE(StepUntil([&] { return said_["a"] == "here \n"; }));
  ASSERT_EQ(info_.cmds.size(), 2U);
  EXPECT_EQ(info_.deputy_id, "d");
  EXPECT_GT(info_.phys_mem_total_bytes, info_.phys_mem_free_bytes);
  EXPECT_EQ(info_.cmds[0].cmd.command_id, "a");
  EXPECT_EQ(info_.cmds[0].cmd.group, "g");
  EXPECT_EQ(info_.cmds[0].pid, deputy_->supervisor().Find("a")->pid());
  EXPECT_EQ(info_.cmds[0].actual_runid, 1);
  EXPECT_EQ(info_.cmds[1].pid, 0);
  const int before = n_infos_;
  ASSERT_TRUE(StepUntil([&] { return n_infos_ > before; }));  // 1 Hz
  EXPECT_GT(info_.cmds[0].mem_rss_bytes, 0);
  kill(info_.cmds[0].pid, SIGKILL);
  ASSERT_TRUE(StepUntil([&] { return info_.cmds[0].pid == 0; }));  // on change
  EXPECT_EQ(info_.cmds[0].exit_code, 137);
}

TEST_F(DeputyTest, ObeysOrdersForItsOwnCommandsOnly) {
  Order("a", 5, false);
  ASSERT_TRUE(StepUntil([&] { return !info_.cmds.empty() && info_.cmds[0].pid != 0; }));
  EXPECT_EQ(info_.cmds[0].actual_runid, 5);
  EXPECT_EQ(info_.cmds[0].cmd.exec_str, "a");
  const int pid = info_.cmds[0].pid;
  Order("a", 5, false);  // the same again, as a sheriff does each second
  Order("a", 6, false, "another deputy");
  Order("touch", 1, false);
  ASSERT_TRUE(StepUntil([&] { return said_[""].find("\"touch\" is not a command") != std::string::npos; }));
  EXPECT_EQ(info_.cmds[0].pid, pid);
  Order("a", 6, false);
  ASSERT_TRUE(StepUntil([&] { return info_.cmds[0].pid != 0 && info_.cmds[0].pid != pid; }));
  Order("a", 6, true);
  ASSERT_TRUE(StepUntil([&] { return info_.cmds[0].pid == 0; }));
  EXPECT_FALSE(std::filesystem::exists("/tmp/evit_from_the_bus"));
}

TEST_F(DeputyTest, MalformedOrdersAreDroppedAndReported) {
  bus_->Publish(kPmOrders, "garbage", 7);
  ASSERT_TRUE(StepUntil([&] { return said_[""].find("PM_ORDERS was dropped") != std::string::npos; }));
}

TEST_F(DeputyTest, OutputIsLimitedOnTheBusButNotInTheLog) {
  deputy_->supervisor().Start("talks");
  ASSERT_TRUE(StepUntil([&] { return Text("talks.log").size() > 150'000; }));
  EXPECT_LE(said_["talks"].size(), 2U * 65536);
}

// A sheriff's bus: the deputy works whenever the sheriff waits.
class SteppedBus : public Bus {
 public:
  SteppedBus(std::unique_ptr<Bus> inner, std::function<void()> step)
      : inner_(std::move(inner)), step_(std::move(step)) {}
  void Publish(const std::string& channel, const void* data, std::size_t size) override {
    inner_->Publish(channel, data, size);
  }
  void Subscribe(const std::string& channel, Handler handler) override {
    inner_->Subscribe(channel, std::move(handler));
  }
  int Poll(int /*timeout_ms*/) override {
    std::this_thread::sleep_for(1ms);
    step_();
    return inner_->Poll(0);
  }

 private:
  std::unique_ptr<Bus> inner_;
  std::function<void()> step_;
};

TEST_F(DeputyTest, SheriffListsAndCommands) {
  SteppedBus bus(OpenMemoryBus(hub_), [this] { Step(); });
  Sheriff sheriff(&bus);
  sheriff.Give(Sheriff::Order::kStart, "a", 5s);
  const int first = sheriff.Look(1s).at("d").cmds[0].pid;
  EXPECT_GT(first, 0);
  sheriff.Give(Sheriff::Order::kRestart, "a", 5s);
  EXPECT_NE(sheriff.Look(1s).at("d").cmds[0].pid, first);
  sheriff.Give(Sheriff::Order::kStop, "a", 5s);
  EXPECT_EQ(sheriff.Look(1s).at("d").cmds[0].pid, 0);
  EXPECT_THAT([&] { sheriff.Give(Sheriff::Order::kStop, "z", 1s); },
              ThrowsMessage<std::runtime_error>(HasSubstr("there are: a, talks")));
}

TEST(SheriffTest, MissingDeputyIsReported) {
  const auto bus = OpenMemoryBus(MakeMemoryHub());
  Sheriff sheriff(bus.get());
  EXPECT_THAT([&] { sheriff.Give(Sheriff::Order::kStop, "a", 300ms); },
              ThrowsMessage<std::runtime_error>(HasSubstr("no deputy answered")));
}

}  // namespace
}  // namespace evit::procman
