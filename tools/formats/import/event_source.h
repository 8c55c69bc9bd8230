#pragma once

#include <string>

#include "common/events/event.h"
#include "tools/formats/import/drop_counts.h"

namespace evit::formats {

/// Where the events of an import come from, in pieces, so that a long recording never lies in memory whole.
class EventSource {
 public:
  virtual ~EventSource() = default;
  /// Replaces `events` by the next ones (at least one), as they come, all on the sensor. False at the end.
  /// Order of time is ImportLog's (OrderedEvents).
  virtual bool Read(EventArray* events) = 0;
  virtual double share() const = 0;      // of the recording that was read, 0..1
  virtual std::string name() const = 0;  // file or topic, for messages
  virtual DropCounts dropped() const { return {}; }
};

}  // namespace evit::formats
