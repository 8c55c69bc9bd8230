#include "tools/run/latency_probe.h"

#include <gtest/gtest.h>

#include <thread>

#include "common/bus/memory_bus.h"
#include "tests/helpers/bus_messages.h"
#include "tests/helpers/sample_messages.h"

namespace evit::run {
namespace {

class LatencyTest : public ::testing::Test {
 protected:
  template <typename Message>
  void Send(const std::string& channel, const Message& message) {
    test::Publish(bus_.get(), channel, message);
    while (bus_->Poll(0) > 0) {
    }
  }
  void Events(Utime begin, Utime end) {
    event_packet_t m{};
    m.utime = begin;
    m.n = 2;
    m.dt_us = {0, static_cast<std::int32_t>(end - begin)};
    m.x = {1, 2}, m.y = {1, 2}, m.polarity = {0, 1};
    Send(channels_.events, m);
  }
  void Window(Utime t, Utime lookahead) {
    window_state_t m{};
    m.utime = t;
    m.mode = tracker_mode_t::TRACKING;
    m.lookahead_us = lookahead;
    Send(channels_.window_state, m);
  }

  Channels channels_{""};
  std::unique_ptr<Bus> bus_ = OpenMemoryBus(MakeMemoryHub());
  LatencyProbe probe_{bus_.get(), channels_};
};

TEST_F(LatencyTest, CountsFromThePacketThatCompletesTheSurface) {
  Events(990'000, 999'000);  // before the first packet heard nothing can be dated
  Events(1'000'000, 1'004'000);
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  Events(1'005'000, 1'009'000);
  Window(1'003'000, 5'000);  // shows events up to 1'008'000
  const auto events = probe_.pose_after_events(), stamp = probe_.pose_after_stamp();
  ASSERT_EQ(events.count, 1);
  ASSERT_EQ(stamp.count, 1);
  EXPECT_GE(stamp.p50_ms, 30);
  EXPECT_LT(events.p50_ms, stamp.p50_ms - 25);
}

TEST_F(LatencyTest, PosesWithoutAMatchingPacketAreIgnored) {
  Window(1'000'000, 0);  // no events at all
  Events(1'990'000, 1'999'000);
  Events(2'000'000, 2'004'000);
  Window(2'003'000, 5'000);  // its last event never came
  EXPECT_EQ(probe_.pose_after_events().count, 0);
  EXPECT_EQ(probe_.pose_after_stamp().count, 1);
  EXPECT_EQ(probe_.imu_pose().count, 0);
}

}  // namespace
}  // namespace evit::run
