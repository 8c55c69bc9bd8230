#pragma once

#include "common/diagnosis/event_census.h"
#include "common/diagnosis/finding.h"

namespace evit::diagnosis {

/// Rates and gaps, order of the stamps, polarities, size of the sensor, hot and dead pixels, noise, and light
/// that flickers.
Findings CheckEvents(const EventCensus& events);

}  // namespace evit::diagnosis
