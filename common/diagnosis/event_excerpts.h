#pragma once

#include <vector>

#include "common/events/event.h"
#include "common/time/utime.h"

namespace evit::diagnosis {

/// Events around some instants of a recording, kept for comparing them with a map under several assumptions.
class EventExcerpts {
 public:
  /// Around each instant (us, events' clock) `reach` us to either side.
  EventExcerpts(std::vector<Utime> instants, Utime reach);
  /// In order of time.
  void Add(const EventArray& events);
  const std::vector<Utime>& instants() const { return instants_; }
  const std::vector<EventArray>& events() const { return events_; }

 private:
  std::vector<Utime> instants_;
  Utime reach_;
  std::vector<EventArray> events_;
};

}  // namespace evit::diagnosis
