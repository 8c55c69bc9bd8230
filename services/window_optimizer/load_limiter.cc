#include "services/window_optimizer/load_limiter.h"

#include "common/time/milliseconds.h"

namespace evit {

LoadLimiter::Limits LoadLimiter::Begin(const QueuedKeyframe& keyframe, bool shows_load, bool others_wait,
                                       Clock::time_point now) {
  if (shows_load) Observe(Milliseconds(now - keyframe.arrived));
  const double interval = 1e-3 * Milliseconds(keyframe.arrived - last_arrived_);
  last_arrived_ = keyframe.arrived;
  return {governor_.point_share(), LoadGovernor::SolveBudget(interval, others_wait)};
}

void LoadLimiter::Observe(double waited_ms) {
  const int before = governor_.level();
  governor_.Observe(waited_ms);
  status_->AddTiming("wait", waited_ms);
  if (governor_.level() == before) return;
  status_->Counter("overload.level") = governor_.level();
  if (governor_.level() > before) ++status_->Counter("overload.steps");
}

}  // namespace evit
