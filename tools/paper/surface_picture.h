#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "common/geometry/rig.h"
#include "common/map/map_index.h"
#include "tools/paper/keyframe_log.h"

namespace evit::paper {

/// Points of the map that the camera sees from there (map frame), a random subset of at most `most`.
std::vector<Eigen::Vector3f> VisibleFrom(const MapIndex& map, const Rig& rig, const SE3& T_map_body,
                                         int most);

/// A keyframe's time surface (dark: events just now) with points projected onto it from a pose. BGR, `zoom`
/// times as large as the sensor.
cv::Mat SurfaceWithPoints(const RecordedKeyframe& keyframe, const Rig& rig,
                          const std::vector<Eigen::Vector3f>& points, const SE3& T_map_body,
                          const cv::Scalar& color, double zoom);

}  // namespace evit::paper
