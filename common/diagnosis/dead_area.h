#pragma once

#include <optional>

#include "common/diagnosis/event_census.h"
#include "common/diagnosis/finding.h"

namespace evit::diagnosis {

/// A rectangle of pixels that never fired, or hardly, though those along its edges did: columns, rows or a
/// block that the sensor does not deliver. What a plain part of the scene leaves out has no straight edges.
struct DeadArea {
  int left = 0, top = 0, right = 0, bottom = 0;  // pixels, all four inside
  int beside = 0;                                // pixels along its edges, on the sensor
  int beside_fired = 0;                          // of these
  double usual = 0;   // share of the pixels next to a silent one that fired, anywhere on the sensor
  double chance = 0;  // bound of the probability that it comes about by that
  int width() const { return right - left + 1; }
  int height() const { return bottom - top + 1; }
};

/// The largest one of at least half a percent of the sensor, along whose edges as many pixels fire as further
/// out; that chance stops there so often is less likely than 1 in 10,000.
std::optional<DeadArea> FindDeadArea(const EventCensus& events);

/// Are there columns, rows or a block without events?
Finding CheckDeadArea(const EventCensus& events);

}  // namespace evit::diagnosis
