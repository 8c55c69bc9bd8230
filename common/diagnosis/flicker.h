#pragma once

#include "common/diagnosis/event_census.h"

namespace evit::diagnosis {

/// How strongly the share of brightening among the events swings with a period of light on mains power. A
/// lamp on 50 Hz brightens and darkens everything 100 times a second.
struct Flicker {
  double hz = 0;      // of the strongest
  double swing = 0;   // amplitude of (brighter - darker) / all, 0..1
  double excess = 0;  // that over what neighbouring frequencies have (median)
};
/// The strongest of 50, 60, 100 and 120 Hz. No swing below 1 s.
Flicker FindFlicker(const EventCensus& events);

}  // namespace evit::diagnosis
