#include "tools/formats/event_packet/event_packet_decoder.h"

#include <stdexcept>

#include "common/files/load_number.h"

namespace evit::formats {
namespace {

// 64 bits an event: polarity (1), row (15), column (16), ns after the packet's time base (32).
void DecodeMono(const EventPacket& packet, EventArray* events) {
  for (std::size_t at = 0; at + 8 <= packet.size; at += 8) {
    const auto word = LoadNumber<std::uint64_t>(packet.data + at);
    events->push_back(static_cast<Utime>((packet.time_base + (word & 0xFFFF'FFFFU)) / 1000),
                      static_cast<std::uint16_t>(word >> 32),
                      static_cast<std::uint16_t>((word >> 48) & 0x7FFF),
                      static_cast<std::uint8_t>(word >> 63));
  }
}

// libcaer's polarity events: column (15), row (15), polarity, valid; then 31 bits of stamp, us after the time
// base.
void DecodeLibcaer(const EventPacket& packet, EventArray* events) {
  Utime base = static_cast<Utime>(packet.time_base / 1000);
  std::uint32_t before = 0;
  for (std::size_t at = 0; at + 8 <= packet.size; at += 8) {
    const auto word = LoadNumber<std::uint32_t>(packet.data + at);
    const std::uint32_t stamp = LoadNumber<std::uint32_t>(packet.data + at + 4) & 0x7FFF'FFFFU;
    if (stamp < before && before - stamp > 0x4000'0000U) base += Utime{1} << 31;
    before = stamp;
    events->push_back(base + stamp, word >> 17, (word >> 2) & 0x7FFF, (word >> 1) & 1);
  }
}

// 16-bit words like EVT 3.0's, but vectors run along a column; 24 bits of stamp after the packet's time base.
void DecodeLibcaerCompressed(const EventPacket& packet, EventArray* events) {
  enum Code : unsigned { kTimeHigh, kTimeLow, kAddrX, kAddrY, kVectBaseY, kVect8, kVect12 };
  Utime base = static_cast<Utime>(packet.time_base / 1000);
  std::uint16_t high = 0, low = 0, x = 0, base_y = 0;
  std::uint8_t polarity = 0;
  const auto time = [&] { return base + (Utime{high} << 12) + low; };
  for (std::size_t at = 0; at + 2 <= packet.size; at += 2) {
    const auto word = LoadNumber<std::uint16_t>(packet.data + at);
    const std::uint16_t rest = word & 0xFFF;
    switch (word >> 12) {
      case kTimeHigh:
        if (rest < high && high - rest > 0x800) base += Utime{1} << 24;
        high = rest;
        break;
      case kTimeLow:
        low = rest;
        break;
      case kAddrX:
        x = rest & 0x7FF;
        break;
      case kAddrY:
        events->push_back(time(), x, rest & 0x7FF, static_cast<std::uint8_t>(rest >> 11));
        break;
      case kVectBaseY:
        base_y = rest & 0x7FF;
        polarity = static_cast<std::uint8_t>(rest >> 11);
        break;
      case kVect8:
      case kVect12: {
        const bool twelve = word >> 12 == kVect12;
        for (unsigned valid = rest & (twelve ? 0xFFFU : 0xFFU); valid != 0; valid &= valid - 1)
          events->push_back(time(), x, static_cast<std::uint16_t>(base_y + __builtin_ctz(valid)), polarity);
        base_y = static_cast<std::uint16_t>(base_y + (twelve ? 12 : 8));
        break;
      }
      default:
        break;
    }
  }
}

}  // namespace

bool EventPacketDecoder::HostTime(const std::string& encoding) {
  return encoding == "libcaer" || encoding == "libcaer_cmp";
}

void EventPacketDecoder::Decode(const EventPacket& packet, EventArray* events) {
  if (packet.encoding == "evt3") {
    evt3_.Decode(packet.data, packet.size, true, events);
  } else if (packet.encoding == "mono") {
    DecodeMono(packet, events);
  } else if (packet.encoding == "libcaer") {
    DecodeLibcaer(packet, events);
  } else if (packet.encoding == "libcaer_cmp") {
    DecodeLibcaerCompressed(packet, events);
  } else if (packet.encoding != "trigger") {
    throw std::runtime_error("the encoding \"" + packet.encoding +
                             "\" is not known; known are evt3, mono, libcaer and libcaer_cmp");
  }
}

}  // namespace evit::formats
