#include "tools/simulation/light.h"

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

double Cover::Factor(Utime t) const {
  if (to <= from) return 1;
  const Utime outside = std::max({from - t, t - to, Utime{0}});
  const double open =
      std::min(1.0, static_cast<double>(outside) / static_cast<double>(std::max<Utime>(1, ramp)));
  return open * open;
}

}  // namespace evit::simulation
