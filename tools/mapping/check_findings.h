#pragma once

#include <string>
#include <vector>

#include "tools/mapping/map_check.h"

namespace evit::mapping {

/// What the figures say is wrong, errors first, and what mends it.
std::vector<CheckFinding> Findings(const MapCheckInputs& inputs, const MapCheck& check);

/// The likeliest first: of two that fit alike, the one with fewer unknowns.
void SortByMerit(std::vector<Misplacement>* fits);

/// A misplacement as "the events are 12.0 ms late", ...
std::string Describe(const Misplacement& fit);

/// Whether it is large enough, and fits so much better, that it is worth a word.
bool IsWorthAWord(const Misplacement& fit, double share_as_is);

}  // namespace evit::mapping
