#include "common/events/stream_guard.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace evit {
namespace {

// Ten packets of a hundred events, 10 us apart.
EventArray Packet(int k) {
  EventArray events;
  for (int i = 0; i < 100; ++i) events.push_back(1000 * k + 10 * i, static_cast<std::uint16_t>(i), 0, 1);
  return events;
}

class StreamGuardTest : public ::testing::Test {
 protected:
  void Add(EventArray events) {
    const Utime last = events.t.back();
    guard_.AddEvents(std::move(events), last, [&](const EventArray& good, Utime watermark) {
      out_.insert(out_.end(), good.t.begin(), good.t.end());
      watermark_ = watermark;
    });
  }
  StreamGuard guard_;
  std::vector<Utime> out_;
  Utime watermark_ = 0;
};

TEST_F(StreamGuardTest, OneEventInTheFutureCostsItselfOnly) {
  for (const Utime ahead : {Utime{1'000'000}, Utime{500'000'000}}) {
    for (const int at : {0, 50, 99}) {
      guard_ = {};
      out_.clear();
      for (int k = 0; k < 10; ++k) {
        EventArray packet = Packet(k);
        if (k == 5) packet.t[static_cast<std::size_t>(at)] += ahead;
        Add(packet);
      }
      EXPECT_EQ(out_.size(), 999U) << ahead << " at " << at;
      EXPECT_TRUE(std::is_sorted(out_.begin(), out_.end()));
      EXPECT_EQ(guard_.counters().events_ahead, 1);
      EXPECT_EQ(watermark_, 9990);
    }
  }
}

TEST_F(StreamGuardTest, DisorderWithinAPacketIsSorted) {
  EventArray packet = Packet(0);
  std::reverse(packet.t.begin(), packet.t.end());
  Add(packet);
  EXPECT_EQ(out_.size(), 100U);
  EXPECT_TRUE(std::is_sorted(out_.begin(), out_.end()));
  EXPECT_EQ(guard_.counters().events_sorted, 99);
}

TEST_F(StreamGuardTest, AGapIsBelievedWithTheNextPacket) {
  Add(Packet(0));
  Add(Packet(5000));
  EXPECT_EQ(out_.size(), 100U);
  Add(Packet(5001));
  EXPECT_EQ(out_.size(), 300U);
  EXPECT_EQ(guard_.counters().events_ahead, 0);
  Add(Packet(20'000));
  guard_.Flush([&](const EventArray& good, Utime) { out_.insert(out_.end(), good.t.begin(), good.t.end()); },
               [](const ImuSample&) {});
  EXPECT_EQ(out_.size(), 400U);
}

TEST_F(StreamGuardTest, OneImuSampleInTheFutureCostsItselfOnly) {
  std::vector<Utime> out;
  for (int k = 0; k < 20; ++k) {
    ImuSample s;
    s.t = 5000 * k + (k == 7 ? 500'000'000 : 0);
    guard_.AddImu(s, [&](const ImuSample& good) { out.push_back(good.t); });
  }
  EXPECT_EQ(out.size(), 19U);
  EXPECT_EQ(guard_.counters().imu_ahead, 1);
}

}  // namespace
}  // namespace evit
