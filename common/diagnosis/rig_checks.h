#pragma once

#include "common/diagnosis/finding.h"
#include "common/geometry/rig.h"

namespace evit::diagnosis {

/// Is the calibration plausible by itself? Intrinsics, extrinsics, time offset.
Findings CheckRig(const Rig& rig);

}  // namespace evit::diagnosis
