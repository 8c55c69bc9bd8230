#pragma once

#include <memory>
#include <string>

#include "tools/formats/import/event_source.h"
#include "tools/formats/import/import_log.h"

namespace evit::formats {

/// What a recording says of itself before its events are read.
struct RecordingInfo {
  std::string format;         // for people, e.g. "Metavision RAW, EVT3"
  std::string sensor;         // as the file names it; empty: it does not
  int width = 0, height = 0;  // pixels; 0: the file does not say
  bool measured = false;      // the size is what the events need, not what the file says
};

/// A recording of some format, opened. The readers of one format each implement it.
class Recording {
 public:
  virtual ~Recording() = default;
  virtual RecordingInfo info() const = 0;
  /// A pass over all events, from the first one on; events outside the size are counted and left out.
  virtual std::unique_ptr<EventSource> Events(int width, int height) = 0;
  /// IMU samples (body axes, rad/s and m/s^2, stamps of the events' clock) and truth as recorded: poses of
  /// whatever body the recording has, in its own frame. Empty where it holds none.
  virtual ImportStreams Streams() = 0;
};

}  // namespace evit::formats
