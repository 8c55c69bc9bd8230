#include "common/overlap/extrinsics_plausibility.h"

#include <cstdio>
#include <vector>

#include "common/overlap/map_event_overlap.h"

namespace evit {
namespace {

constexpr double kLies = 0.15, kLiesNot = 0.3;  // kappa; and as a share of the other one

double Agreement(const Rig& rig, const MapIndex& map, const Trajectory& body, const EventArray& events) {
  MapViewOptions options;
  options.step = 50'000;
  std::vector<MapView> views = PlanViews(map, rig, body, options);
  ViewFiller(&views).AddEvents(events);
  return views.empty() ? 0 : MeasureOverlap(rig, views).kappa();
}

}  // namespace

std::string ExtrinsicsComplaint(const Rig& rig, const MapIndex& map, const Trajectory& body,
                                const EventArray& events) {
  Rig inverted = rig;
  inverted.T_body_camera = rig.T_body_camera.Inverse();
  const double given = Agreement(rig, map, body, events), other = Agreement(inverted, map, body, events);
  if (other < kLies || given > kLiesNot * other) return "";
  char text[300];
  std::snprintf(text, sizeof text,
                "T_body_camera looks like its inverse: at the start the map and the events agree by %.2f as "
                "it stands, by "
                "%.2f inverted; Kalibr's T_cam_imu has to be inverted (or give its camchain.yaml as --rig)",
                given, other);
  return text;
}

}  // namespace evit
