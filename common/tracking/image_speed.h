#pragma once

#include <vector>

#include "common/tracking/event_alignment.h"

namespace evit {

/// Median speed (pixels/s) at which map points move over the image for a body at this pose, with this
/// velocity (m/s, map frame) and angular rate (rad/s, body frame). 0 where no point is in view.
double MedianImageSpeed(const AlignmentSettings& settings, const AlignmentPoints& points,
                        const SE3& T_map_body, const Eigen::Vector3d& velocity, const Eigen::Vector3d& rate);

}  // namespace evit
