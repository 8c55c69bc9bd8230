#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/formats/aedat/aedat_decoder.h"

namespace evit::formats {

/// AEDAT 3.1 of cAER: little-endian packets of one type each.
class Aedat3Decoder : public AedatDecoder {
 public:
  std::size_t Decode(const std::uint8_t* data, std::size_t size, EventArray* events,
                     std::vector<ImuSample>* imu) override;
};

}  // namespace evit::formats
