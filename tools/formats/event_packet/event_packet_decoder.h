#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/events/event.h"
#include "tools/formats/prophesee/evt3_decoder.h"

namespace evit::formats {

/// event_camera_msgs/EventPacket, its bytes where they lie.
struct EventPacket {
  Utime stamp = 0;  // header: host time of the first event
  std::uint32_t width = 0, height = 0;
  std::uint64_t time_base = 0;  // ns
  std::string encoding;
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Decodes the packets of one topic, in their order, by the encodings that the message's own page describes:
/// evt3, mono, libcaer, libcaer_cmp. Keeps state: evt3 continues from packet to packet.
class EventPacketDecoder {
 public:
  /// Appends the events with the time that the encoding gives. Throws std::runtime_error where the encoding
  /// is another.
  void Decode(const EventPacket& packet, EventArray* events);

  /// Whether an encoding's time is that of the host already; otherwise it is the sensor's own clock.
  static bool HostTime(const std::string& encoding);
  std::int64_t unstamped() const { return evt3_.unstamped(); }

 private:
  Evt3Decoder evt3_;
};

}  // namespace evit::formats
