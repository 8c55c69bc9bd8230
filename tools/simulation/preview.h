#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/events/event.h"
#include "common/geometry/rig.h"
#include "common/map/point_map.h"
#include "tools/simulation/moving_box.h"
#include "tools/simulation/pose_spline.h"
#include "tools/simulation/renderer.h"

namespace evit::simulation {

/// Pictures for people: rendered image | events of 10 ms (red positive, blue negative) | the map projected at
/// the true pose over the same events. The map must lie on the events.
class Preview {
 public:
  /// `count` instants spread over begin..end; 0: none. `box`: null where there is none.
  Preview(const Renderer& renderer, const Rig& rig, const PoseSpline& motion, Utime begin, Utime end,
          int count, const MovingBox* box);

  /// All events, in order.
  void Add(const EventArray& events);

  /// Writes file("preview_000.png") and so on. Throws std::runtime_error naming the file.
  void Write(const PointMap& map, const std::function<std::string(const std::string&)>& file) const;

 private:
  struct Instant {
    Utime t;
    EventArray events;  // within 5 ms of t
  };
  const Renderer& renderer_;
  const Rig& rig_;
  const PoseSpline& motion_;
  const MovingBox* box_;
  std::vector<Instant> instants_;
};

}  // namespace evit::simulation
