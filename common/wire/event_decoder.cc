#include "common/wire/event_decoder.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "common/bus/field_checks.h"
#include "common/bus/wire_layout.h"
#include "common/events/event_order.h"
#include "common/simd/lanes.h"
#include "evit/event_packet_t.hpp"

namespace evit {
namespace {

constexpr std::uint16_t kMaxCoordinate = std::numeric_limits<std::int16_t>::max();

// Numbers of the wire are big-endian.
EVIT_MULTIVERSION void GetTimes(const std::uint8_t* __restrict from, std::size_t n, Utime first,
                                Utime* __restrict t) {
  for (std::size_t i = 0; i < n; ++i) {
    std::uint32_t dt = 0;
    std::memcpy(&dt, from + 4 * i, 4);
    t[i] = first + static_cast<std::int32_t>(__builtin_bswap32(dt));
  }
}

// Returns all of them, one or the other: above kMaxCoordinate where one of them is.
EVIT_MULTIVERSION std::uint16_t GetCoordinates(const std::uint8_t* __restrict from, std::size_t n,
                                               std::uint16_t* __restrict x) {
  std::uint16_t any = 0;
  for (std::size_t i = 0; i < n; ++i) {
    std::uint16_t value = 0;
    std::memcpy(&value, from + 2 * i, 2);
    x[i] = __builtin_bswap16(value);
    any |= x[i];
  }
  return any;
}

EVIT_MULTIVERSION std::uint8_t AnyOf(const std::uint8_t* values, std::size_t n) {
  std::uint8_t any = 0;
  for (std::size_t i = 0; i < n; ++i) any |= values[i];
  return any;
}

}  // namespace

bool DecodeEvents(const std::uint8_t* data, std::size_t size, EventPacket* packet) {
  if (!CheckWire(LayoutOf<event_packet_t>(), event_packet_t::getHash(), data, size, nullptr)) return false;
  // Fingerprint, utime, seq and epoch, the number of events; then dt_us, x, y and polarity of all of them.
  constexpr int kHeader = 4 * sizeof(std::int64_t) + sizeof(std::int32_t);
  std::int64_t stamp[3];
  std::int32_t count = 0;
  __int64_t_decode_array(data, sizeof(std::int64_t), sizeof stamp, stamp, 3);
  __int32_t_decode_array(data, kHeader - int{sizeof count}, sizeof count, &count, 1);
  packet->utime = stamp[0];
  packet->seq = stamp[1];
  packet->epoch = stamp[2];
  if (!FieldChecks(nullptr).Stamp(*packet).ok()) return false;  // before anything is added to utime

  const auto n = static_cast<std::size_t>(count);
  EventArray& events = packet->events;
  events.t.resize(n), events.x.resize(n), events.y.resize(n);
  const std::uint8_t* const from = data + kHeader;
  GetTimes(from, n, packet->utime, events.t.data());
  const std::uint16_t x = GetCoordinates(from + 4 * n, n, events.x.data());
  const std::uint16_t y = GetCoordinates(from + 6 * n, n, events.y.data());
  events.p.assign(from + 8 * n, from + 9 * n);
  return (n == 0 || events.t.front() == packet->utime) && NeverDecreases(events.t.data(), n) &&
         std::max(x, y) <= kMaxCoordinate && AnyOf(events.p.data(), n) <= 1;
}

}  // namespace evit
