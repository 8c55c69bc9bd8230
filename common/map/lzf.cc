#include <cstring>

#include "common/map/map_formats.h"

namespace evit {

bool DecompressLzf(const std::uint8_t* data, std::size_t n, std::uint8_t* out, std::size_t size) {
  std::size_t in = 0, at = 0;
  while (in < n) {
    const unsigned control = data[in++];
    if (control < 32) {  // a run of literal bytes
      const std::size_t run = control + 1;
      if (run > n - in || run > size - at) return false;
      std::memcpy(out + at, data + in, run);
      in += run;
      at += run;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) {
      if (in >= n) return false;
      length += data[in++];
    }
    length += 2;
    if (in >= n) return false;
    const std::size_t back = ((control & 0x1fU) << 8) + data[in++] + 1;
    if (back > at || length > size - at) return false;
    for (std::size_t k = 0; k < length; ++k, ++at) out[at] = out[at - back];  // may overlap: byte by byte
  }
  return at == size;
}

}  // namespace evit
