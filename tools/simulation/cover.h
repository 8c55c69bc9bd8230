#pragma once

#include "common/time/utime.h"

namespace evit::simulation {

/// Something before the lens: no light at all from `from` to `to` (us of the sequence's clock). It comes in
/// the `ramp` before and goes in the `ramp` after, slowly where it is nearly dark: log intensity changes
/// evenly.
struct Cover {
  Utime from = 0, to = 0;  // equal: never covered
  Utime ramp = 100'000;    // us

  double Factor(Utime t) const;
};

}  // namespace evit::simulation
