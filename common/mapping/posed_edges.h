#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/se3.h"
#include "common/mapping/edge_image.h"

namespace evit {

/// How the camera moved while it saw what a view shows, in its own frame. A picture shows all edges whatever
/// the camera did; an event camera only those that the motion carries across pixels.
struct CameraSweep {
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();   // m
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();  // rad, a small rotation vector
  double min_px = 0;  // across an edge, that it takes to show it; 0: all edges are shown

  /// By how many pixels a point of the camera frame moved in the image (focal lengths of `camera`).
  Eigen::Vector2d Flow(const Camera& camera, const Eigen::Vector3d& p) const {
    const Eigen::Vector3d d = -moved - turned.cross(p);
    return {camera.fx * (d.x() - p.x() / p.z() * d.z()) / p.z(),
            camera.fy * (d.y() - p.y() / p.z() * d.z()) / p.z()};
  }
  /// Whether an edge at p with this normal (unit, pixels) is to be expected in the view.
  bool Shows(const Camera& camera, const Eigen::Vector3d& p, const Eigen::Vector2f& normal) const {
    return min_px <= 0 || std::abs(normal.cast<double>().dot(Flow(camera, p))) >= min_px;
  }
  /// Which way such an edge goes: 1 along its normal, -1 against it; 0 in a picture, where nothing comes
  /// late.
  int Way(const Camera& camera, const Eigen::Vector3d& p, const Eigen::Vector2f& normal) const {
    if (min_px <= 0) return 0;
    return normal.cast<double>().dot(Flow(camera, p)) > 0 ? 1 : -1;
  }
};

/// The edges that a camera without distortion saw from a known place.
struct PosedEdges {
  SE3 T_map_camera;
  Camera camera;
  EdgeImage edges;
  CameraSweep sweep = {};
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
  double lag = 0;       // px, by which event views see it behind its place, beside what is known of all
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
