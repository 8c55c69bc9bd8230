#pragma once

#include <vector>

#include "common/events/event.h"
#include "evit/event_packet_t.hpp"

/// Events as they travel: event_packet_t on the bus and in logs.
namespace evit {

/// At most so many events in one packet: 9 bytes each, one UDP datagram.
inline constexpr std::size_t kPacketEvents = 7'000;

/// Cuts sorted events into packets of at most kPacketEvents, each spanning less than 2^31 us; seq counts on
/// from `first_seq`. No packet for no events. Throws std::invalid_argument: times decrease, or a coordinate
/// that does not fit the message.
std::vector<event_packet_t> ToPackets(const EventArray& events, std::int64_t epoch, std::int64_t first_seq);

/// Encodes one such packet, beginning with event `begin`, into `buffer` (its memory is used again): the same
/// bytes as EncodeTo() of it, without a message in between. Returns the first event not in it. Throws as
/// ToPackets().
std::size_t EncodePacket(const EventArray& events, std::size_t begin, std::int64_t epoch, std::int64_t seq,
                         std::vector<std::uint8_t>* buffer);

/// A packet without events: "no event before `watermark` is still to come".
event_packet_t EmptyPacket(Utime watermark, std::int64_t epoch, std::int64_t seq);

/// Appends a packet's events. The packet must have been checked (DecodeChecked): counts agree, times sorted.
/// Negative coordinates become large ones, which lie outside every image.
void AppendEvents(const event_packet_t& packet, EventArray* events);

}  // namespace evit
