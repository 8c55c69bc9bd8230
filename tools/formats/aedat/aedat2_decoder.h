#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/formats/aedat/aedat_decoder.h"

namespace evit::formats {

/// AEDAT 2.0 of jAER: big-endian pairs of address and stamp (us). What an address means depends on the chip:
/// a DAVIS (events, frames, IMU) of this size, or, for 128x128, a DVS128.
class Aedat2Decoder : public AedatDecoder {
 public:
  Aedat2Decoder(int width, int height) : width_(width), height_(height) {}
  std::size_t Decode(const std::uint8_t* data, std::size_t size, EventArray* events,
                     std::vector<ImuSample>* imu) override;

 private:
  void Imu(std::uint32_t address, Utime t, std::vector<ImuSample>* imu);

  int width_, height_;
  std::uint32_t before_ = 0;
  Utime base_ = 0;
  ImuSample sample_;
  int next_ = 0;  // value of the sample that is to come
};

}  // namespace evit::formats
