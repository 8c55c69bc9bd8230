#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/events/event.h"
#include "common/imu/imu_sample.h"

namespace evit::formats {

/// Decodes what follows the header of an AEDAT file of before DV, in pieces.
class AedatDecoder {
 public:
  virtual ~AedatDecoder() = default;
  /// Appends events and IMU samples; returns how many bytes were used up, the rest is to be given again with
  /// what follows. Throws std::runtime_error where the bytes are not of this format.
  virtual std::size_t Decode(const std::uint8_t* data, std::size_t size, EventArray* events,
                             std::vector<ImuSample>* imu) = 0;
};

}  // namespace evit::formats
