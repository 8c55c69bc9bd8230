#pragma once

#include <cstddef>
#include <cstdint>

#include "common/events/event.h"

namespace evit {

/// An event_packet_t with its events as algorithms use them.
struct EventPacket {
  Utime utime = 0;  // us: of the first event, or the watermark of a packet without any
  std::int64_t seq = 0, epoch = 0;
  EventArray events;

  /// us: no event before it is still to come.
  Utime watermark() const { return events.size() > 0 ? events.t.back() : utime; }
};

/// What DecodeChecked() of an event_packet_t and AppendEvents() do, without a message in between: millions of
/// events come this way each second. Replaces the events that `packet` has; their memory is used again.
/// False (packet untouched or partly filled) where DecodeChecked() is.
bool DecodeEvents(const std::uint8_t* data, std::size_t size, EventPacket* packet);

}  // namespace evit
