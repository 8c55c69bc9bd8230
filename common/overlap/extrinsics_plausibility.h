#pragma once

#include <string>

#include "common/overlap/map_views.h"

namespace evit {

/// Whether T_body_camera looks like its inverse, as where Kalibr's T_cam_imu was pasted: at the poses `body`
/// (IMU clock; a known start will do) the map lies on the events with the inverse and not as it stands. A
/// sentence for a person with both agreements (MapEventOverlap::kappa); empty where nothing seems wrong or
/// nothing can be told. `events`: in order, of the time of the poses.
std::string ExtrinsicsComplaint(const Rig& rig, const MapIndex& map, const Trajectory& body,
                                const EventArray& events);

}  // namespace evit
