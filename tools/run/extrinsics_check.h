#pragma once

#include "common/geometry/rig.h"
#include "common/map/point_map.h"
#include "tools/run/log_span.h"
#include "tools/run/run_inputs.h"

namespace evit::run {

/// Throws std::runtime_error where the rig's T_body_camera looks like its inverse (ExtrinsicsComplaint), from
/// the first half second of the log's events at the start pose, or at the truth's where there is one.
void CheckExtrinsics(const RunJob& job, const RunInputs& inputs, const LogSpan& span, const PointMap& map);

}  // namespace evit::run
