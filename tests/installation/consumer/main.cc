// A project that links evit::tracking: a tracker that says which part of the map it wants to see first.
#include <cstdio>

#include "common/tracking/tracker.h"

int main() {
  evit::Rig rig;
  rig.camera.width = 640;
  rig.camera.height = 480;
  rig.camera.fx = rig.camera.fy = 500;
  const evit::Tracker tracker(rig, evit::TrackerOptions(), evit::SE3());
  const evit::VisibilityQuery query = tracker.NextQuery();
  std::printf("%d map points at most, from a camera of %d x %d pixels\n", query.max_points,
              query.camera.width, query.camera.height);
  return query.max_points > 0 && query.camera.width == 640 ? 0 : 1;
}
