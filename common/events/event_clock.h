#pragma once

#include <cstdint>
#include <optional>

#include "common/events/stream_merger.h"

namespace evit {

/// Ticks for recordings and cameras without an IMU: they take the place of its stamps. Where it is not known
/// beforehand that there is none they begin once a second of events has come and no IMU sample. When they
/// come then depends on the events' stamps alone. Where there have been no events for a second they rest
/// until the next one.
class EventClock {
 public:
  static constexpr Utime kStep = 5'000;          // us between two ticks, as IMUs have it
  static constexpr Utime kPatience = 1'000'000;  // us, where it is not known whether there is an IMU
  static constexpr Utime kRest = 1'000'000;      // us without events

  /// `patience`: us of events, in which an IMU sample may still come; 0: it is known that none counts.
  /// `from_first_event`: the first tick is the first event's, so that nothing of a recording is left out;
  /// else (live) the end of the patience, so that nothing has to be made up for.
  EventClock(Utime patience, bool from_first_event)
      : patience_(patience), from_first_event_(from_first_event) {}

  struct Tick {
    Utime t = 0;          // us
    bool begins = false;  // it follows none: the first one, or the first after a rest
  };
  /// The next tick, where all events up to it are known; nothing where they are not, or an IMU has come
  /// before.
  std::optional<Tick> Next(const StreamMerger& merger);
  /// Goes on to the tick after that.
  void Pop();
  /// Forgets everything: a new stream begins.
  void Clear() { *this = EventClock(patience_, from_first_event_); }

  /// Whether it has begun, so that no IMU counts any more.
  bool running() const { return running_; }

 private:
  bool Start(const StreamMerger& merger);
  void See(const StreamMerger& merger);

  Utime patience_;
  bool from_first_event_;
  bool running_ = false, begins_ = true;
  Utime tick_ = 0;             // us: the next
  Utime newest_ = 0;           // us: of the newest event up to the next tick
  std::int64_t position_ = 0;  // after that event
};

}  // namespace evit
