#pragma once

#include <utility>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/se3.h"
#include "common/mapping/edge_image.h"

namespace evit {

/// The edges that a camera without distortion saw from a known place.
struct PosedEdges {
  SE3 T_map_camera;
  Camera camera;
  EdgeImage edges;
};

/// A point on an edge of the scene, map frame, metres.
struct MappedPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  // Unit, along the edge; the brighter side is on the left of it as the camera sees it.
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  double sigma = 0;     // m, across the edge, in the worst direction
  double views = 0;     // that agree on it
  double seen = 0;      // of the views that should show it, the share that does; 0..1
  double contrast = 0;  // step of log intensity; 0: not known
};

/// A point's image in a camera without distortion at T_camera_map; false where it is not in front.
struct PinholeView {
  PinholeView(const SE3& T_map_camera, const Camera& camera)
      : R(T_map_camera.R().transpose()), t(-(R * T_map_camera.p)), camera(camera) {}

  Eigen::Vector3d InCamera(const Eigen::Vector3d& p_map) const { return R * p_map + t; }
  Eigen::Vector2d Pixel(const Eigen::Vector3d& p) const {
    return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
  }
  /// d(pixel)/d(p) of a point of the camera frame.
  Eigen::Matrix<double, 2, 3> Jacobian(const Eigen::Vector3d& p) const {
    Eigen::Matrix<double, 2, 3> j;
    j << camera.fx / p.z(), 0, -camera.fx * p.x() / (p.z() * p.z()), 0, camera.fy / p.z(),
        -camera.fy * p.y() / (p.z() * p.z());
    return j;
  }

  Eigen::Matrix3d R;  // camera from map
  Eigen::Vector3d t;
  Camera camera;
};

}  // namespace evit
