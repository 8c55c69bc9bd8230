#pragma once

#include <string>
#include <vector>

#include "common/diagnosis/finding.h"
#include "common/evaluation/trajectory.h"
#include "common/events/event.h"
#include "common/geometry/rig.h"
#include "common/map/map_index.h"

namespace evit::diagnosis {

/// Events around some instants of a recording, kept for comparing them with a map under several assumptions.
class EventExcerpts {
 public:
  /// Around each instant (us, events' clock) `reach` us to either side.
  EventExcerpts(std::vector<Utime> instants, Utime reach);
  /// In order of time.
  void Add(const EventArray& events);
  const std::vector<Utime>& instants() const { return instants_; }
  const std::vector<EventArray>& events() const { return events_; }

 private:
  std::vector<Utime> instants_;
  Utime reach_;
  std::vector<EventArray> events_;
};

/// Does the map lie on the events where the truth says that it must, and if not, what would make it so? Tried
/// are: the extrinsics inverted or turned, the truth's body being the camera, other time offsets, a mirrored
/// image, another resolution, axes of the map turned, and where it is nowhere near, its unit.
Findings CheckOverlap(const MapIndex& map, const Rig& rig, const Trajectory& truth,
                      const EventExcerpts& excerpts);

}  // namespace evit::diagnosis
