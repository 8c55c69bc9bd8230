#pragma once

#include "common/files/decimal_time.h"

namespace evit::formats {

/// What to multiply a time of this unit by for microseconds.
inline double MicrosPerUnit(TimeUnit unit) {
  switch (unit) {
    case TimeUnit::kSeconds:
      return 1e6;
    case TimeUnit::kMilliseconds:
      return 1e3;
    case TimeUnit::kMicroseconds:
      return 1;
    default:
      return 1e-3;
  }
}

}  // namespace evit::formats
