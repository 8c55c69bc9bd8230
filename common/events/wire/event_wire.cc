#include "common/events/wire/event_wire.h"

#include <limits>
#include <stdexcept>

namespace evit {
namespace {

constexpr int kMaxCoordinate = std::numeric_limits<std::int16_t>::max();

std::size_t EndOfPacket(const EventArray& events, std::size_t begin) {
  std::size_t end = begin;
  while (end < events.size() && end - begin < kPacketEvents &&
         events.t[end] - events.t[begin] <= std::numeric_limits<std::int32_t>::max()) {
    ++end;
  }
  return end;
}

}  // namespace

std::vector<event_packet_t> ToPackets(const EventArray& events, std::int64_t epoch, std::int64_t first_seq) {
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (i > 0 && events.t[i] < events.t[i - 1]) {
      throw std::invalid_argument("event " + std::to_string(i) +
                                  " is earlier than the one before: sort first");
    }
    if (events.x[i] > kMaxCoordinate || events.y[i] > kMaxCoordinate) {
      throw std::invalid_argument("event " + std::to_string(i) + ": pixel coordinate above 32767");
    }
  }
  std::vector<event_packet_t> packets;
  for (std::size_t begin = 0; begin < events.size();) {
    const std::size_t end = EndOfPacket(events, begin);
    event_packet_t packet = EmptyPacket(events.t[begin], epoch, first_seq++);
    packet.n = static_cast<std::int32_t>(end - begin);
    packet.dt_us.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      packet.dt_us.push_back(static_cast<std::int32_t>(events.t[i] - events.t[begin]));
    }
    packet.x.assign(events.x.begin() + begin, events.x.begin() + end);
    packet.y.assign(events.y.begin() + begin, events.y.begin() + end);
    packet.polarity.assign(events.p.begin() + begin, events.p.begin() + end);
    packets.push_back(std::move(packet));
    begin = end;
  }
  return packets;
}

event_packet_t EmptyPacket(Utime watermark, std::int64_t epoch, std::int64_t seq) {
  event_packet_t packet{};
  packet.utime = watermark;
  packet.epoch = epoch;
  packet.seq = seq;
  return packet;
}

void AppendEvents(const event_packet_t& packet, EventArray* events) {
  const auto n = static_cast<std::size_t>(packet.n);
  events->t.reserve(events->size() + n);
  for (const std::int32_t dt : packet.dt_us) events->t.push_back(packet.utime + dt);
  events->x.insert(events->x.end(), packet.x.begin(), packet.x.end());
  events->y.insert(events->y.end(), packet.y.begin(), packet.y.end());
  events->p.insert(events->p.end(), packet.polarity.begin(), packet.polarity.end());
}

}  // namespace evit
