#pragma once

#include <string>
#include <vector>

#include "tools/mapping/map_check.h"

namespace evit::mapping {

/// What the figures say is wrong, most important first, and what mends it.
std::vector<std::string> Findings(const MapCheckInputs& inputs, const MapCheck& check);

/// A misplacement as "the events are 12.0 ms late", ...
std::string Describe(const Misplacement& fit);

/// Whether it is large enough, and fits so much better, that it is worth a word.
bool IsWorthAWord(const Misplacement& fit, double share_as_is);

}  // namespace evit::mapping
