#include "common/diagnosis/rising_samples.h"

namespace evit::diagnosis {

std::vector<ImuSample> RisingSamples(const std::vector<ImuSample>& samples) {
  std::vector<ImuSample> rising;
  for (const ImuSample& s : samples)
    if (rising.empty() || s.t > rising.back().t) rising.push_back(s);
  return rising;
}

}  // namespace evit::diagnosis
