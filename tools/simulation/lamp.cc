#include "tools/simulation/lamp.h"

#include <algorithm>

namespace evit::simulation {

double Lamp::Factor(Utime t) const {
  if (on <= off) return 1;
  const auto progress = [&](Utime start) {
    return std::clamp(static_cast<double>(t - start) / static_cast<double>(std::max<Utime>(1, ramp)), 0.0,
                      1.0);
  };
  return 1 - (1 - share) * (progress(off) - progress(on));
}

}  // namespace evit::simulation
