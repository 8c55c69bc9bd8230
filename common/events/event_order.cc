#include "common/events/event_order.h"

#include "common/simd/lanes.h"

namespace evit {

EVIT_MULTIVERSION bool NeverDecreases(const Utime* t, std::size_t n) {
  Utime decrease = 0;
  for (std::size_t i = 1; i < n; ++i) decrease |= t[i] - t[i - 1];
  return decrease >= 0;  // its sign is set where one of them is negative
}

}  // namespace evit
