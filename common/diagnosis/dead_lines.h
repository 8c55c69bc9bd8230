#pragma once

#include "common/diagnosis/event_census.h"
#include "common/diagnosis/finding.h"

namespace evit::diagnosis {

/// Whole rows or columns that never fire, or hardly, though those beside them do, as often right beside as
/// some pixels further out: a scene fades over some pixels, a dead line does not.
struct DeadLines {
  int rows = 0, columns = 0;  // how many
  int first_row = -1, first_column = -1;
};
DeadLines FindDeadLines(const EventCensus& events);

/// Two or more count: sensors are sold with one.
Finding CheckDeadLines(const EventCensus& events);

}  // namespace evit::diagnosis
