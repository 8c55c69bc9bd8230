#pragma once

#include <cstddef>

namespace evit::simulation {

/// How many events a simulation made.
struct EventCounts {
  std::size_t positive = 0, negative = 0, noise = 0;  // noise: part of the other two
  std::size_t lost = 0;                               // beyond the readout's bandwidth
  double peak_rate = 0;                               // events/s, most in any 10 ms
  std::size_t total() const { return positive + negative; }
};

}  // namespace evit::simulation
