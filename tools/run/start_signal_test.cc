#include "tools/run/start_signal.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "common/bus/memory_bus.h"
#include "tests/helpers/bus_messages.h"

namespace evit::run {
namespace {

class StartSignalTest : public ::testing::Test {
 protected:
  StartSignalTest() { test::Keep(services_.get(), channels_.replay_control, &orders_); }
  void Say(const std::string& service, const std::string& state, double progress = 0) {
    service_status_t status{};
    status.service = service;
    status.state = state;
    status.progress = progress;
    test::Publish(services_.get(), channels_.status, status);
    bus_->Poll(0);
  }
  void SayAll(const std::string& replay) {
    for (const char* name : {"map_server", "window_optimizer", "frame_builder"}) Say(name, "running");
    Say("log_replay", replay);
  }
  // Orders after a time in which one would be repeated.
  std::size_t OrdersAfter(std::chrono::milliseconds time) {
    std::this_thread::sleep_for(time);
    start_.Tick(recorder_);
    services_->Poll(0);
    return orders_.size();
  }

  std::shared_ptr<MemoryHub> hub_ = MakeMemoryHub();
  std::unique_ptr<Bus> bus_ = OpenMemoryBus(hub_), services_ = OpenMemoryBus(hub_);
  Channels channels_;
  Recorder recorder_{bus_.get(), channels_};
  Remote remote_{bus_.get(), channels_};
  StartSignal start_{&remote_};
  std::vector<replay_control_t> orders_;
};

constexpr std::chrono::milliseconds kNone(0), kRepeated(510);

TEST_F(StartSignalTest, WaitsForAllServicesAndRepeatsAnOrderThatGotLost) {
  Say("log_replay", "paused");
  EXPECT_EQ(OrdersAfter(kNone), 0U);
  SayAll("paused");
  EXPECT_EQ(OrdersAfter(kNone), 1U);
  EXPECT_EQ(OrdersAfter(kNone), 1U);
  EXPECT_EQ(OrdersAfter(kRepeated), 2U);
  EXPECT_EQ(orders_.back().command, replay_control_t::RESUME);
  EXPECT_FALSE(start_.begun());
}

TEST_F(StartSignalTest, APauseAfterTheBeginHolds) {
  SayAll("paused");
  EXPECT_EQ(OrdersAfter(kNone), 1U);
  Say("log_replay", "running", 0.1);
  EXPECT_EQ(OrdersAfter(kNone), 1U);
  EXPECT_TRUE(start_.begun());
  EXPECT_FALSE(recorder_.paused());
  Say("log_replay", "paused", 0.2);
  EXPECT_TRUE(recorder_.paused());
  EXPECT_EQ(OrdersAfter(kRepeated), 1U);
}

TEST_F(StartSignalTest, APauseThatComesBeforeTheFirstWordOfPlayingHoldsToo) {
  SayAll("paused");
  EXPECT_EQ(OrdersAfter(kNone), 1U);
  Say("log_replay", "paused", 0.01);
  EXPECT_EQ(OrdersAfter(kRepeated), 1U);
}

}  // namespace
}  // namespace evit::run
