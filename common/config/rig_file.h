#pragma once

#include <string>

#include "common/geometry/rig.h"

namespace evit {

/// Writes a rig file that LoadRig reads back exactly, with the unit of each value. `comment`: where the
/// figures come from, one or more lines without '#'. Throws std::runtime_error naming the file.
void WriteRig(const std::string& path, const Rig& rig, const std::string& name, const std::string& comment);

}  // namespace evit
