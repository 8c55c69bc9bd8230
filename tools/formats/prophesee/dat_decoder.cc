#include "tools/formats/prophesee/dat_decoder.h"

#include <cstring>

namespace evit::formats {

std::size_t DatDecoder::Decode(const std::uint8_t* data, std::size_t size, bool /*last*/,
                               EventArray* events) {
  const std::size_t n = size / 8;
  for (std::size_t k = 0; k < n; ++k) {
    std::uint32_t word[2];
    std::memcpy(word, data + 8 * k, 8);
    if (before_ > 0xF000'0000U && word[0] < 0x1000'0000U) base_ += Utime{1} << 32;
    before_ = word[0];
    events->push_back(base_ + word[0], word[1] & 0x3FFF, (word[1] >> 14) & 0x3FFF,
                      (word[1] >> 28) != 0 ? 1 : 0);
  }
  return 8 * n;
}

}  // namespace evit::formats
