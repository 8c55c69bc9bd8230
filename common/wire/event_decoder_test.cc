#include "common/wire/event_decoder.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "common/bus/codec.h"
#include "common/wire/event_wire.h"

namespace evit {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// n events, two of them at each instant.
event_packet_t Packet(int n) {
  event_packet_t m = EmptyPacket(1'642'661'138'836'530, 42, 7);
  for (int k = 0; k < n; ++k) {
    m.dt_us.push_back(k / 2 * 100'000);
    m.x.push_back(static_cast<std::int16_t>(k * 7919 % 32768));
    m.y.push_back(static_cast<std::int16_t>(k * 10473 % 32768));
    m.polarity.push_back(k % 3 == 0);
  }
  m.n = n;
  return m;
}

Bytes Encoded(const event_packet_t& m) {
  Bytes bytes;
  EncodeTo(m, &bytes);
  return bytes;
}

/// Whether DecodeEvents() took it; fails where the message's own way does otherwise.
bool TakenAsByMessage(const Bytes& bytes, EventPacket* packet) {
  event_packet_t m;
  const bool taken = DecodeChecked(bytes.data(), bytes.size(), &m);
  EXPECT_EQ(DecodeEvents(bytes.data(), bytes.size(), packet), taken);
  if (!taken) return false;
  EventArray expected;
  AppendEvents(m, &expected);
  EXPECT_EQ(packet->utime, m.utime);
  EXPECT_EQ(packet->seq, m.seq);
  EXPECT_EQ(packet->epoch, m.epoch);
  EXPECT_EQ(packet->events.t, expected.t);
  EXPECT_EQ(packet->events.x, expected.x);
  EXPECT_EQ(packet->events.y, expected.y);
  EXPECT_EQ(packet->events.p, expected.p);
  return true;
}

TEST(EventDecoder, GivesWhatTheMessageGives) {
  EventPacket packet;  // used again: for more events, for fewer, for none
  for (const int n : {5, 7'000, 1, 33, 0, 16}) {
    EXPECT_TRUE(TakenAsByMessage(Encoded(Packet(n)), &packet)) << n;
    EXPECT_EQ(packet.watermark(), packet.utime + (n > 0 ? (n - 1) / 2 * 100'000 : 0));
  }
}

TEST(EventDecoder, RefusesWhatTheMessageRefuses) {
  const std::vector<std::function<void(event_packet_t*)>> faults = {
      [](event_packet_t* m) { m->dt_us[0] = -1; },
      [](event_packet_t* m) { m->dt_us[20] = m->dt_us[19] - 1; },
      [](event_packet_t* m) { m->x[39] = -1; },
      [](event_packet_t* m) { m->y[3] = -32768; },
      [](event_packet_t* m) { m->polarity[17] = 2; },
      [](event_packet_t* m) { m->seq = -1; },
      [](event_packet_t* m) { m->utime = std::numeric_limits<std::int64_t>::max(); },
      [](event_packet_t* m) { m->utime = std::numeric_limits<std::int64_t>::min(); }};
  EventPacket packet;
  for (std::size_t k = 0; k < faults.size(); ++k) {
    event_packet_t m = Packet(40);
    faults[k](&m);
    EXPECT_FALSE(TakenAsByMessage(Encoded(m), &packet)) << k;
  }
}

TEST(EventDecoder, AgreesOnBytesThatWereChangedOrCutOff) {
  std::mt19937 random(1);
  const Bytes whole = Encoded(Packet(12));
  EventPacket packet;
  int taken = 0;
  for (int k = 0; k < 5'000; ++k) {
    Bytes bytes = whole;
    bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    if (k % 4 == 0) bytes.resize(random() % (bytes.size() + 1));
    taken += TakenAsByMessage(bytes, &packet) ? 1 : 0;
  }
  EXPECT_GT(taken, 500);
  EXPECT_LT(taken, 4'500);
}

}  // namespace
}  // namespace evit
