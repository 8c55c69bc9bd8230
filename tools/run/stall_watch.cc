#include "tools/run/stall_watch.h"

#include <algorithm>

namespace evit::run {
namespace {

// Heartbeats and polling of all services together take less of a processor.
constexpr double kBusy = 0.2;
// A longer gap between two ticks is this process's own: it was stopped, or had no processor either.
constexpr double kLongestTick = 2;  // s

}  // namespace

void StallWatch::Progress() { idle_ = computed_ = 0; }

void StallWatch::Tick(double now, const ServiceTime& used) {
  const double elapsed = now - now_, computing = std::max(0.0, used.computing - used_.computing),
               waiting = std::max(0.0, used.waiting - used_.waiting);
  const bool first = now_ < 0;
  now_ = now;
  used_ = used;
  if (first || elapsed <= 0) return;
  computed_ += computing;
  if (computing + waiting < kBusy * elapsed) idle_ += std::min(elapsed, kLongestTick);
}

}  // namespace evit::run
