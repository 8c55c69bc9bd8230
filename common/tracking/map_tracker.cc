#include "common/tracking/map_tracker.h"

#include "common/tracking/event_only_tracker.h"
#include "common/tracking/tracker.h"

namespace evit {

std::unique_ptr<MapTracker> MakeTracker(const Rig& rig, const TrackerOptions& options,
                                        const SE3& T_map_body) {
  if (options.event_only) return std::make_unique<EventOnlyTracker>(rig, options, T_map_body);
  return std::make_unique<Tracker>(rig, options, T_map_body);
}

}  // namespace evit
