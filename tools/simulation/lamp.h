#pragma once

#include "common/time/utime.h"

namespace evit::simulation {

/// The lamp: ambient light falls to `share` from `off` to `on` (us of the sequence's clock), each over a
/// ramp.
struct Lamp {
  Utime off = 0, on = 0;  // equal: never off
  double share = 0.35;
  Utime ramp = 30'000;  // us

  double Factor(Utime t) const;
};

}  // namespace evit::simulation
