#include "common/wire/event_wire.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "common/bus/codec.h"
#include "tests/helpers/event_streams.h"

namespace evit {
namespace {

TEST(EventWire, PacketsGiveTheEventsBack) {
  const EventArray events = test::RandomStream(5'000'000'000, 5'001'000'000, 20'000, 1);
  const std::vector<event_packet_t> packets = ToPackets(events, 42, 100);
  ASSERT_EQ(packets.size(), 3u);
  EventArray back;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const event_packet_t& p = packets[i];
    EXPECT_EQ(p.epoch, 42);
    EXPECT_EQ(p.seq, 100 + static_cast<std::int64_t>(i));
    EXPECT_LE(p.n, 7'000);
    EXPECT_EQ(p.dt_us.front(), 0);
    EXPECT_LE(p.getEncodedSize(), 63 * 1024);
    AppendEvents(p, &back);
  }
  EXPECT_EQ(back.t, events.t);
  EXPECT_EQ(back.x, events.x);
  EXPECT_EQ(back.y, events.y);
  EXPECT_EQ(back.p, events.p);
}

TEST(EventWire, EncodedDirectlyItIsTheSameBytes) {
  EventArray events;
  for (int k = 0; k < 20'000; ++k) {
    events.push_back(1'642'661'138'836'530 + Utime{k} * (k % 7), 0, 0, 0);
    events.x.back() = static_cast<std::uint16_t>(k * 7919 % 32768);
    events.y.back() = static_cast<std::uint16_t>(k * 104729 % 480);
    events.p.back() = k % 2;
  }
  std::sort(events.t.begin(), events.t.end());
  std::vector<std::uint8_t> direct, through_message;
  std::size_t begin = 0;
  std::int64_t seq = 5;
  for (const event_packet_t& packet : ToPackets(events, 99, 5)) {
    EncodeTo(packet, &through_message);
    begin = EncodePacket(events, begin, 99, seq++, &direct);
    EXPECT_EQ(direct, through_message);
  }
  EXPECT_EQ(begin, events.size());
  events.t[3] = 0;
  EXPECT_THROW(EncodePacket(events, 0, 99, 0, &direct), std::invalid_argument);
}

TEST(EventWire, LongPausesBeginANewPacket) {
  EventArray events;
  events.push_back(0, 1, 1, 1);
  events.push_back(3'000'000'000, 1, 1, 1);  // 32 bits hold 35 minutes
  const std::vector<event_packet_t> packets = ToPackets(events, 1, 0);
  ASSERT_EQ(packets.size(), 2u);
  EXPECT_EQ(packets[1].utime, 3'000'000'000);
}

TEST(EventWire, RefusesWhatTheMessageCannotSay) {
  EventArray unsorted;
  unsorted.push_back(10, 1, 1, 1);
  unsorted.push_back(9, 1, 1, 1);
  EXPECT_THROW(ToPackets(unsorted, 1, 0), std::invalid_argument);
  EventArray far;
  far.push_back(10, 40'000, 1, 1);
  EXPECT_THROW(ToPackets(far, 1, 0), std::invalid_argument);
  EXPECT_TRUE(ToPackets({}, 1, 0).empty());
}

TEST(EventWire, NegativeCoordinatesLieOutsideEveryImage) {
  event_packet_t p = EmptyPacket(10, 1, 0);
  p.n = 1;
  p.dt_us = {0};
  p.x = {-1};
  p.y = {3};
  p.polarity = {1};
  EventArray events;
  AppendEvents(p, &events);
  EXPECT_EQ(events.x[0], 65'535);
}

}  // namespace
}  // namespace evit
