#pragma once

#include <string>

#include "common/time/utime.h"

namespace evit::pictures {

/// Time from left to right: the same in all pictures of a recording, whatever poses they show, so that they
/// can be laid side by side.
struct TimeAxis {
  Utime zero = 0;            // us: where 0 is
  Utime begin = 0, end = 0;  // us: shown at least; nothing asked for where end is not after begin
  std::string of = "recording";

  double At(Utime t) const { return ToSeconds(t - zero); }  // s
  std::string Label() const { return "time since the start of the " + of + " [s]"; }
};

}  // namespace evit::pictures
