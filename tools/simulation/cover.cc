#include "tools/simulation/cover.h"

#include <algorithm>

namespace evit::simulation {

double Cover::Factor(Utime t) const {
  if (to <= from) return 1;
  const Utime outside = std::max({from - t, t - to, Utime{0}});
  const double open =
      std::min(1.0, static_cast<double>(outside) / static_cast<double>(std::max<Utime>(1, ramp)));
  return open * open;
}

}  // namespace evit::simulation
