#pragma once

#include <benchmark/benchmark.h>

namespace evit::bench {

/// Items per second, with their target and the memory that each moves at least.
inline void PerSecond(benchmark::State& state, double items_per_iteration, double target,
                      double bytes_per_item) {
  state.counters["items/s"] =
      benchmark::Counter(items_per_iteration, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["target_items/s"] = target;
  state.counters["bytes_per_item"] = bytes_per_item;
}

/// Seconds per call, with their target and the memory that a call moves at least.
inline void PerCall(benchmark::State& state, double target_seconds, double bytes) {
  state.counters["target_s"] = target_seconds;
  state.counters["bytes"] = bytes;
}

}  // namespace evit::bench
