#pragma once

#include "tools/formats/prophesee/event_decoder.h"
#include "tools/formats/prophesee/time_high.h"

namespace evit::formats {

/// EVT 3.0: little-endian words of 16 bits that say only what changes (docs.prophesee.ai, EVT 3.0 Format).
/// The stamp has 24 bits and wraps every 16.8 s.
class Evt3Decoder : public EventDecoder {
 public:
  std::size_t Decode(const std::uint8_t* data, std::size_t size, bool last, EventArray* events) override;

 private:
  bool HandleTimeHigh(const std::uint8_t* data, std::size_t k, std::size_t n, bool last);

  TimeHigh<12> high_;
  Utime time_ = 0;
  std::uint16_t low_ = 0, y_ = 0, base_x_ = 0;
  std::uint8_t polarity_ = 0;  // of the vector
};

}  // namespace evit::formats
