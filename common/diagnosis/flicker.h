#pragma once

#include <vector>

#include "common/diagnosis/event_census.h"
#include "common/diagnosis/finding.h"

namespace evit::diagnosis {

/// How strongly the share of brightening among the events swings with a period of light on mains power. A
/// lamp on 50 Hz brightens and darkens everything 100 times a second.
struct Flicker {
  double hz = 0;      // of the strongest
  double swing = 0;   // amplitude of (brighter - darker) / all, 0..1
  double excess = 0;  // that over what neighbouring frequencies have (median)
  bool Certain() const { return swing > 0.25 && excess > 6; }
};
/// The strongest of 50, 60, 100 and 120 Hz among `bins` of a millisecond. No swing below 1 s.
Flicker FindFlicker(const std::vector<EventCensus::Bin>& bins);

/// Does the light flicker, in all of the image or in parts of it that have a tenth of the events?
Finding CheckFlicker(const EventCensus& events);

}  // namespace evit::diagnosis
