#pragma once

#include <string>

#include "common/evaluation/trajectory.h"
#include "tools/locate/locator_run.h"

namespace evit::locate {

/// Whether a pose counts as right: 10 cm, 3 degrees.
bool IsRight(const SE3& pose, const SE3& truth);

/// How a start went, for a person: when the map was searched, how far off the vertical was, how significant
/// the places were and which of them was right; and what the tracker said, wherever that changed. Lines,
/// indented.
std::string TraceText(const LocatorResult& result, const Trajectory& truth);

enum class Claim { kNone, kRight, kWrong };
/// What would be claimed without following places over time: the first answer whose best place is as
/// significant, and as far ahead of the second, as one that is followed has to be.
Claim AtOnce(const LocatorResult& result, const Trajectory& truth);

}  // namespace evit::locate
