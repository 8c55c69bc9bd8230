#pragma once

#include <chrono>
#include <string>

#include "tools/run/latency_probe.h"
#include "tools/run/outages.h"

namespace evit::run {

/// How a run went, beside what the recorder heard.
struct RunOutcome {
  std::string ended;  // "finished" or "interrupted"
  double wall_s = 0;
  const LatencyProbe* latency = nullptr;  // real time only
  std::chrono::steady_clock::time_point begin, end;
  const Outages* outages = nullptr;
};

}  // namespace evit::run
