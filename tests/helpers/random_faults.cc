#include "tests/helpers/random_faults.h"

namespace evit::doctor {

std::vector<RandomFault> RandomFaults() {
  std::vector<RandomFault> all = RandomEventFaults();
  for (const auto& more : {RandomImuFaults(), RandomRigFaults(), RandomMapFaults()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

// Not std::uniform_real_distribution, whose draws differ between libraries.
double Draw(Chance* chance, double low, double high) {
  return low + (high - low) * (static_cast<double>((*chance)()) / 4294967296.0);
}

int Pick(Chance* chance, int n) { return static_cast<int>(Draw(chance, 0, n)); }

double Either(Chance* chance, double low, double high) { return Pick(chance, 2) == 0 ? low : high; }

Eigen::Vector3d DrawDirection(Chance* chance) {
  Eigen::Vector3d v;
  do {
    for (int k = 0; k < 3; ++k) v[k] = Draw(chance, -1, 1);
  } while (v.norm() > 1 || v.norm() < 0.1);
  return v.normalized();
}

}  // namespace evit::doctor
