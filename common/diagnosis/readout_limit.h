#pragma once

#include <optional>
#include <vector>

#include "common/diagnosis/event_census.h"
#include "common/diagnosis/finding.h"

namespace evit::diagnosis {

/// Where events come as fast as the sensor's readout, or a rate limit of its driver, lets them: then they
/// come evenly. The number of events in a millisecond varies at least as a Poisson variable does where each
/// fires by itself, and more where edges come and go; behind a queue that is full it hardly varies at all.
struct ReadoutLimit {
  double rate = 0;     // events/s at the limit; 0: never reached
  double seconds = 0;  // for how long
};
ReadoutLimit FindReadoutLimit(const std::vector<EventCensus::Bin>& bins);

/// A warning where the limit is reached for 50 ms and more.
std::optional<Finding> CheckReadoutLimit(const EventCensus& events);

}  // namespace evit::diagnosis
