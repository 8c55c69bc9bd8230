#pragma once

#include "tools/formats/prophesee/event_decoder.h"

namespace evit::formats {

/// Metavision's DAT files, event type CD (docs.prophesee.ai, DAT File Format): 8 bytes an event,
/// little-endian: u32 stamp (us), then column (14 bits), row (14), polarity (4). A stamp that wraps after 71
/// minutes is continued.
class DatDecoder : public EventDecoder {
 public:
  std::size_t Decode(const std::uint8_t* data, std::size_t size, bool last, EventArray* events) override;

 private:
  std::uint32_t before_ = 0;
  Utime base_ = 0;
};

}  // namespace evit::formats
