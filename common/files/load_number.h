#pragma once

#include <cstring>

namespace evit {

/// The number whose bytes begin at `bytes`, aligned or not. Formats store them little-endian, as every
/// machine does that EVIT is built for.
template <typename Number>
Number LoadNumber(const void* bytes) {
  Number value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

}  // namespace evit
