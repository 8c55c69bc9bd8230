#pragma once

#include <cstdint>

namespace evit {

/// Time of the sensor clock in microseconds. Durations too: never a float of seconds between modules.
using Utime = std::int64_t;

inline constexpr Utime kMicrosPerSecond = 1'000'000;

/// Seconds of a duration, for arithmetic inside one algorithm.
inline double ToSeconds(Utime duration) { return static_cast<double>(duration) * 1e-6; }

}  // namespace evit
