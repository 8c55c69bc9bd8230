#pragma once

#include <functional>
#include <optional>
#include <string>

#include "common/diagnosis/finding.h"
#include "common/geometry/se3.h"

namespace evit::doctor {

struct Patient {
  std::string log, rig;      // files; needed
  std::string map, truth;    // files, or empty
  std::optional<SE3> start;  // T_map_body; without it the truth's, where there is one
  double seconds = 60;       // of the log
};

/// Everything that can be told of a recording, what is wrong first. `progress`: 0..1. Throws
/// std::runtime_error where a file cannot be read, with its name and the remedy.
diagnosis::Findings Examine(const Patient& patient, const std::function<void(double)>& progress);

/// What Examine has no way to look at without the files that were not given, and the option for each; empty
/// where nothing is missing.
std::string NotChecked(const Patient& patient);

}  // namespace evit::doctor
