#pragma once

#include <cstdint>

namespace evit::simulation {

/// Four values at a time, in a vector every x86-64 has: for code that compilers do not make vectors of. (GCC
/// makes slow code of longer ones.)
using Floats = float __attribute__((vector_size(16)));
using Ints = std::int32_t __attribute__((vector_size(16)));

/// To 0..high.
inline Floats Clamp(Floats x, float high) {
  const Floats zero{}, top{high, high, high, high};
  const Floats low = x < zero ? zero : x;
  return low > top ? top : low;
}

}  // namespace evit::simulation
