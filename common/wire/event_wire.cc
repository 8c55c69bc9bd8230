#include "common/wire/event_wire.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "common/simd/lanes.h"

namespace evit {
namespace {

constexpr int kMaxCoordinate = std::numeric_limits<std::int16_t>::max();

std::size_t EndOfPacket(const EventArray& events, std::size_t begin) {
  const std::size_t end = std::min(events.size(), begin + kPacketEvents);
  const Utime last = events.t[begin] + std::numeric_limits<std::int32_t>::max();
  if (events.t[end - 1] <= last) return end;
  const auto first = events.t.begin();
  return static_cast<std::size_t>(std::upper_bound(first + static_cast<std::ptrdiff_t>(begin),
                                                   first + static_cast<std::ptrdiff_t>(end), last) -
                                  first);
}

// One pass without branches; what is wrong is looked for only where something is.
void CheckOrder(const EventArray& events, std::size_t begin, std::size_t end) {
  bool fine = true;
  for (std::size_t i = begin + 1; i < end; ++i) fine &= events.t[i - 1] <= events.t[i];
  unsigned largest = 0;
  for (std::size_t i = begin; i < end; ++i) largest |= static_cast<unsigned>(events.x[i] | events.y[i]);
  if (fine && largest <= kMaxCoordinate) return;
  for (std::size_t i = begin; i < end; ++i) {
    if (i > begin && events.t[i] < events.t[i - 1]) {
      throw std::invalid_argument("event " + std::to_string(i) +
                                  " is earlier than the one before: sort first");
    }
    if (events.x[i] > kMaxCoordinate || events.y[i] > kMaxCoordinate) {
      throw std::invalid_argument("event " + std::to_string(i) + ": pixel coordinate above 32767");
    }
  }
}

// Numbers of the wire are big-endian.
template <typename Number>
std::uint8_t* Put(Number value, std::uint8_t* to) {
  for (int shift = 8 * static_cast<int>(sizeof value) - 8; shift >= 0; shift -= 8) {
    *to++ = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> shift);
  }
  return to;
}

EVIT_MULTIVERSION void AddTimes(Utime first, const std::int32_t* __restrict dt, std::size_t n,
                                Utime* __restrict t) {
  for (std::size_t i = 0; i < n; ++i) t[i] = first + dt[i];
}

EVIT_MULTIVERSION void PutTimes(const Utime* t, std::size_t n, std::uint8_t* to) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t swapped = __builtin_bswap32(static_cast<std::uint32_t>(t[i] - t[0]));
    std::memcpy(to + 4 * i, &swapped, 4);
  }
}

EVIT_MULTIVERSION void PutCoordinates(const std::uint16_t* x, std::size_t n, std::uint8_t* to) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint16_t swapped = __builtin_bswap16(x[i]);
    std::memcpy(to + 2 * i, &swapped, 2);
  }
}

}  // namespace

std::vector<event_packet_t> ToPackets(const EventArray& events, std::int64_t epoch, std::int64_t first_seq) {
  CheckOrder(events, 0, events.size());
  std::vector<event_packet_t> packets;
  for (std::size_t begin = 0; begin < events.size();) {
    const std::size_t end = EndOfPacket(events, begin);
    event_packet_t packet = EmptyPacket(events.t[begin], epoch, first_seq++);
    packet.n = static_cast<std::int32_t>(end - begin);
    const std::size_t n = end - begin;
    packet.dt_us.resize(n), packet.x.resize(n), packet.y.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      packet.dt_us[i] = static_cast<std::int32_t>(events.t[begin + i] - events.t[begin]);
    }
    std::copy_n(events.x.begin() + static_cast<std::ptrdiff_t>(begin), n, packet.x.begin());
    std::copy_n(events.y.begin() + static_cast<std::ptrdiff_t>(begin), n, packet.y.begin());
    packet.polarity.assign(events.p.begin() + static_cast<std::ptrdiff_t>(begin),
                           events.p.begin() + static_cast<std::ptrdiff_t>(end));
    packets.push_back(std::move(packet));
    begin = end;
  }
  return packets;
}

std::size_t EncodePacket(const EventArray& events, std::size_t begin, std::int64_t epoch, std::int64_t seq,
                         std::vector<std::uint8_t>* buffer) {
  // The end is looked for by time: in order, as far as the packet could reach.
  CheckOrder(events, begin, std::min(events.size(), begin + kPacketEvents));
  const std::size_t end = EndOfPacket(events, begin), n = end - begin;
  buffer->resize(4 * sizeof(std::int64_t) + sizeof(std::int32_t) + 9 * n);
  std::uint8_t* to = buffer->data();
  to = Put(event_packet_t::getHash(), to);
  to = Put(std::int64_t{events.t[begin]}, to);
  to = Put(seq, to);
  to = Put(epoch, to);
  to = Put(static_cast<std::int32_t>(n), to);
  PutTimes(events.t.data() + begin, n, to);
  PutCoordinates(events.x.data() + begin, n, to + 4 * n);
  PutCoordinates(events.y.data() + begin, n, to + 6 * n);
  std::copy_n(events.p.data() + begin, n, to + 8 * n);
  return end;
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
  const std::size_t begin = events->size();
  events->t.resize(begin + n);
  AddTimes(packet.utime, packet.dt_us.data(), n, events->t.data() + begin);
  events->x.insert(events->x.end(), packet.x.begin(), packet.x.end());
  events->y.insert(events->y.end(), packet.y.begin(), packet.y.end());
  events->p.insert(events->p.end(), packet.polarity.begin(), packet.polarity.end());
}

}  // namespace evit
