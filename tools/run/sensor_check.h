#pragma once

#include "common/geometry/camera.h"
#include "tools/run/log_span.h"

namespace evit::run {

/// Throws std::runtime_error where more than a twentieth of the events lie outside the rig's image: the rig
/// file is of another camera or resolution.
void CheckSensor(const RunJob& job, const LogSpan& span, const Camera& camera);

}  // namespace evit::run
