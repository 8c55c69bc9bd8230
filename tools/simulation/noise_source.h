#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulation/event_sensor.h"
#include "tools/simulation/random.h"

namespace evit::simulation {

/// Events that no light caused: background activity of all pixels and a few hot pixels, as Poisson processes.
class NoiseSource {
 public:
  NoiseSource(int width, int height, const EventSensorSettings& settings, std::uint64_t seed);

  /// Appends the noise events in (last t1, t1].
  void Until(std::int32_t t1, std::vector<EventSensor::Event>* events);

 private:
  struct Process {
    double next;     // us
    double mean_us;  // gap
    int x, y;        // -1: any pixel
  };
  int width_, height_;
  Random random_;
  std::vector<Process> processes_;
};

}  // namespace evit::simulation
