#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulation/event_sensor.h"
#include "tools/simulation/random.h"

namespace evit::simulation {

/// What happens to events between pixels and the file.
struct ReadoutSettings {
  double burst_share = 0;  // of events that are followed by another of the same pixel and polarity, and so on
  double burst_gap_ms = 0.3;  // mean time until then
  double rate_hz = 0;         // events that are read out in a second, at most; 0: any number
  double patience_ms = 10;    // an event that would wait longer is lost
};

/// Bursts and the bandwidth of the arbiter: events leave one by one in order of time, late where many come at
/// once, and those that would have to wait too long are lost.
class Readout {
 public:
  Readout(const ReadoutSettings& settings, std::uint64_t seed);

  /// Events of one step, sorted, none after `until` (us) and none before the step before: replaced by those
  /// that leave the sensor, sorted. Bursts that continue after `until` come with later steps.
  void Pass(std::int32_t until, std::vector<EventSensor::Event>* events);
  std::size_t lost() const { return lost_; }

 private:
  void AddBursts(std::int32_t until, std::vector<EventSensor::Event>* events);

  ReadoutSettings settings_;
  Random random_;
  std::vector<EventSensor::Event> later_;
  double free_from_ = 0;  // us: when the next event can leave
  std::size_t lost_ = 0;
};

}  // namespace evit::simulation
