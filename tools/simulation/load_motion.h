#pragma once

#include "common/geometry/rig.h"
#include "tools/simulation/motion.h"
#include "tools/simulation/motion_settings.h"

namespace evit::simulation {

/// Whether the source is made by formula, not a file.
bool IsBuiltin(const MotionSettings& settings);

/// Reads or makes a motion and smooths it. Throws std::runtime_error: unreadable or unordered file, unknown
/// builtin, clip outside the file or shorter than 0.5 s, settings out of range.
Motion LoadMotion(const MotionSettings& settings, const Rig& rig);

}  // namespace evit::simulation
