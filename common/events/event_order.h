#pragma once

#include <cstddef>

#include "common/time/utime.h"

namespace evit {

/// Whether none of n times lies before the one that precedes it. In vectors: events pass several such checks.
/// Times must be less than 2^63 us apart.
bool NeverDecreases(const Utime* t, std::size_t n);

}  // namespace evit
