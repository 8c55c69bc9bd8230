#pragma once

#include <cstdint>
#include <vector>

#include "common/events/event.h"

namespace evit {

/// How the image as a whole moved between two windows of events.
struct FlowSample {
  Utime t = 0;            // us, between the windows
  double vx = 0, vy = 0;  // pixels/s
};

/// Measures it from the events' counts per column and per row: the shift at which those of one window fit
/// those of the one before best. Rotation about the camera's x and y axes moves everything alike and is what
/// this sees; coarse, but at any scene and without calibration.
class EventFlow {
 public:
  EventFlow(int width, int height);

  /// Further events in order of time.
  void Add(const EventArray& events);
  const std::vector<FlowSample>& samples() const { return samples_; }

  static constexpr Utime kWindow = 20'000;  // us

 private:
  struct Counts {
    std::vector<float> x, y;
    std::int64_t n = 0;
  };
  void Close();

  Counts now_, before_;
  Utime end_ = 0;  // of the window that is being filled; 0: none yet
  std::vector<FlowSample> samples_;
};

}  // namespace evit
