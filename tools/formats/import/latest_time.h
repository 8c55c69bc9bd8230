#pragma once

#include "common/time/utime.h"

namespace evit::formats {

/// No date of a recording is later, us (the year 2096, counted from 1970): a stamp beyond it is damaged.
inline constexpr Utime kLatestTime = 4'000'000'000'000'000;

}  // namespace evit::formats
