#pragma once

#include <vector>

#include "common/imu/imu_sample.h"

namespace evit::diagnosis {

/// The samples whose stamps are later than all before them: what can be integrated of a recording whose
/// order another check looks at.
std::vector<ImuSample> RisingSamples(const std::vector<ImuSample>& samples);

}  // namespace evit::diagnosis
