#pragma once

#include <string>

#include "bench/table.h"

namespace evit::bench {

/// Each family of rows named "Scaling, FAMILY/..." as FAMILY.csv, and all of them as scaling.png, into
/// `folder`.
void WriteCurves(const Results& results, const std::string& folder);

}  // namespace evit::bench
