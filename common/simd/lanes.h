#pragma once

/// Loops over many points in blocks of kLanes, in single precision, written so that the compiler makes
/// vectors of them. EVIT_MULTIVERSION compiles a function for AVX2 and for every x86-64 (and _WIDE for
/// AVX-512), and the loader picks; all give the same bits, since every lane does the same IEEE operations
/// (-ffp-contract=off, no reassociation).
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define EVIT_MULTIVERSION __attribute__((target_clones("default", "avx2")))
// For loops of much arithmetic with many sums, which gain from twice as many registers of twice the width.
#define EVIT_MULTIVERSION_WIDE __attribute__((target_clones("default", "avx2", "arch=x86-64-v4")))
#else  // the sanitizers' start-up does not bear the loader's choice
#define EVIT_MULTIVERSION
#define EVIT_MULTIVERSION_WIDE
#endif
#define EVIT_ALWAYS_INLINE inline __attribute__((always_inline))

namespace evit {

/// Points are taken in blocks of so many: two AVX2 vectors, four SSE ones.
inline constexpr int kLanes = 16;

}  // namespace evit
