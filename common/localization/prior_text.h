#pragma once

#include <string>

#include "common/localization/place_query.h"

namespace evit {

/// What is known of the place, as people type it; empty: not known. `near`: "x y z radius" in m; `height`:
/// "low:high" in m; `yaw`: "degrees:tolerance", of the body's x axis from the map's x towards its y. Throws
/// std::runtime_error naming the option (--near, --height, --yaw), the text and what was expected.
PlacePrior ParsePlacePrior(const std::string& near, const std::string& height, const std::string& yaw);

/// "within 0.3 m of (3.00, 3.00, 1.00), between 1.00 and 2.00 m high, at a yaw of 90 +- 20 deg"; empty where
/// nothing is known.
std::string PriorText(const PlacePrior& prior);

}  // namespace evit
