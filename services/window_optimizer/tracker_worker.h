#pragma once

#include <future>
#include <memory>
#include <optional>

#include "common/tracking/map_tracker.h"
#include "services/window_optimizer/keyframe_queue.h"
#include "services/window_optimizer/processed_keyframe.h"

namespace evit {

/// A tracker and the thread it works in. The tracker has one owner at a time: this, while it is at rest, and
/// the thread while it works on a keyframe. Whoever asks for it meanwhile gets none, so that nothing else
/// can touch a tracker that works.
class TrackerWorker {
 public:
  enum class Threading {
    kOwnThread,     // real time: what comes meanwhile is dealt with at once
    kCallersThread  // in Finish(kWait)
  };
  TrackerWorker(std::unique_ptr<MapTracker> tracker, Threading threading);

  /// The tracker while it is idle, else null. Do not store it.
  MapTracker* idle_tracker() const { return tracker_.get(); }
  bool working() const { return work_.valid(); }

  /// Begins with a keyframe. `input`: what the tracker needs of it. The tracker must be at rest.
  void Start(QueuedKeyframe keyframe, KeyframeInput input);

  enum class Wait { kNo, kYes };
  /// What came of the keyframe, with the tracker at rest again. None where it is not done (Wait::kNo) or
  /// nothing was begun. Throws what the tracker threw.
  std::optional<ProcessedKeyframe> Finish(Wait wait);

 private:
  struct Work {
    std::unique_ptr<MapTracker> tracker;
    TrackerOutput output;
    double solve_ms;
  };
  std::launch policy_;
  std::unique_ptr<MapTracker> tracker_;  // null while its thread has it
  QueuedKeyframe keyframe_;              // in work
  std::future<Work> work_;               // last member: the thread ends before anything else is gone
};

}  // namespace evit
