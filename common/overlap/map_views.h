#pragma once

#include <cstdint>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/events/event.h"
#include "common/geometry/rig.h"
#include "common/map/map_index.h"
#include "common/overlap/pixel_set.h"

namespace evit {

/// What a camera at a known pose should see of a map, and what fired around that instant.
struct MapView {
  Utime utime = 0;                      // us, IMU clock: middle of the slice of events
  Utime begin = 0, end = 0;             // us, the events' own clock: [begin, end)
  SE3 T_map_body;                       // at utime
  std::vector<Eigen::Vector3f> points;  // visible in a frame some pixels wider than the image; map frame, m
  double speed_px = 0;                  // pixels/s: median over the points of their motion over the image
  PixelSet fired;                       // pixels with an event in the slice
  std::int64_t n_events = 0;            // in the slice, inside the image
};

struct MapViewOptions {
  Utime step = 100'000;                      // us between views
  double slice_px = 3;                       // a slice lasts until the points have moved so far
  Utime shortest = 2'000, longest = 40'000;  // us: bounds of that
  int max_points = 5000;                     // of one view: a random subset where there are more
  double margin_px = 20;                     // how much wider than the image the view is on each side
  bool occlusion = true;                     // leave out points hidden behind nearer ones
};

/// Views along a trajectory of the body (IMU clock), `step` apart, where it has poses on both sides and the
/// map has points in view; slices of events lie symmetrically around them. Their events come by AddEvents.
std::vector<MapView> PlanViews(const MapIndex& map, const Rig& rig, const Trajectory& body,
                               const MapViewOptions& options = {});

/// Puts a recording's events, in order of time and piece by piece, into the slices of its views.
class ViewFiller {
 public:
  /// `views`: in order of time; must outlive this.
  explicit ViewFiller(std::vector<MapView>* views) : views_(views) {}
  void AddEvents(const EventArray& events);

 private:
  std::vector<MapView>* views_;
  std::size_t first_ = 0;  // view whose slice may still be open
};

}  // namespace evit
