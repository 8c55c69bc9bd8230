#pragma once

/// Before a function with hot loops: compiled once for every x86-64 and once with AVX2 (without fused
/// multiply-add), the fitting one is chosen when the program starts. Both give the same bits. Sanitizers
/// cannot start with such functions.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define EVIT_VECTOR_CODE __attribute__((target_clones("avx2", "default")))
#else
#define EVIT_VECTOR_CODE
#endif
