#pragma once

#include "tools/formats/prophesee/event_decoder.h"
#include "tools/formats/prophesee/time_high.h"

namespace evit::formats {

/// EVT 2.0: little-endian words of 32 bits, one event each (docs.prophesee.ai, EVT 2.0 Format).
class Evt2Decoder : public EventDecoder {
 public:
  std::size_t Decode(const std::uint8_t* data, std::size_t size, bool last, EventArray* events) override;

 private:
  TimeHigh<28> high_;
};

/// EVT 2.1: words of 64 bits, each up to 32 events of one row (docs.prophesee.ai, EVT 2.1 Format). Sensors
/// send them in two orders: whole and little-endian (GenX320), or the upper half first, each half
/// little-endian (IMX636, "legacy").
class Evt21Decoder : public EventDecoder {
 public:
  explicit Evt21Decoder(bool upper_half_first) : upper_half_first_(upper_half_first) {}
  std::size_t Decode(const std::uint8_t* data, std::size_t size, bool last, EventArray* events) override;

  /// Which order the stream that begins so has, by how often one TIME_HIGH follows another; `otherwise` where
  /// that does not tell.
  static bool UpperHalfFirst(const std::uint8_t* data, std::size_t size, bool otherwise = false);

 private:
  bool upper_half_first_;
  TimeHigh<28> high_;
};

}  // namespace evit::formats
