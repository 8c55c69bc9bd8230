#pragma once

#include <cstdint>

/// Before a function with hot loops: compiled once for every x86-64 and once with AVX2 (without fused
/// multiply-add), the fitting one is chosen when the program starts. Both give the same bits. Sanitizers
/// cannot start with such functions.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define EVIT_VECTOR_CODE __attribute__((target_clones("avx2", "default")))
#else
#define EVIT_VECTOR_CODE
#endif

namespace evit {

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

}  // namespace evit
