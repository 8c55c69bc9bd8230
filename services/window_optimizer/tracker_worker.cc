#include "services/window_optimizer/tracker_worker.h"

#include <chrono>
#include <utility>

#include "common/time/milliseconds.h"

namespace evit {

TrackerWorker::TrackerWorker(std::unique_ptr<MapTracker> tracker, Threading threading)
    : policy_(threading == Threading::kOwnThread ? std::launch::async : std::launch::deferred),
      tracker_(std::move(tracker)) {}

void TrackerWorker::Start(QueuedKeyframe keyframe, KeyframeInput input) {
  keyframe_ = std::move(keyframe);
  work_ = std::async(policy_, [tracker = std::move(tracker_), input = std::move(input)]() mutable {
    const auto begin = std::chrono::steady_clock::now();
    TrackerOutput output = tracker->Process(input);
    const double solve_ms = Milliseconds(std::chrono::steady_clock::now() - begin);
    return Work{std::move(tracker), std::move(output), solve_ms};
  });
}

std::optional<ProcessedKeyframe> TrackerWorker::Finish(Wait wait) {
  if (!working()) return std::nullopt;
  if (wait == Wait::kNo && work_.wait_for(std::chrono::seconds(0)) == std::future_status::timeout)
    return std::nullopt;
  Work work = work_.get();
  tracker_ = std::move(work.tracker);
  return ProcessedKeyframe{std::move(keyframe_), std::move(work.output), work.solve_ms};
}

}  // namespace evit
