#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/mapping/posed_edges.h"

namespace evit {

constexpr double kNearestPoint = 0.05;  // m ahead of the camera; no nearer one is looked for

/// What one view shows of a point on an edge: how far off the edge it is seen as, across.
struct EdgeSighting {
  bool found = false;  // an edge; the rest tells of it
  double off = 0;      // pixels
  int way = 0;         // that its edge goes, see CameraSweep
  // d(off)/d(point), the point in the camera frame; pixels per metre.
  Eigen::RowVector3d by_point = Eigen::RowVector3d::Zero();

  /// Robust, of an edge known to within `edge_sigma_px` (px^-2).
  double Weight(double edge_sigma_px) const;
  /// Near enough to count as the point's own edge.
  bool Agrees() const;
};

/// Of the point at `p` in the camera frame, its edge looked for within `radius` pixels. Nothing where the
/// view is not expected to show it: it points at the camera, or the motion does not carry it across pixels.
std::optional<EdgeSighting> SightEdge(const PinholeView& pinhole, const PosedEdges& view,
                                      const MappedPoint& point, const Eigen::Vector3d& p, double radius);

/// The indices of the points that are in the picture and not behind others.
std::vector<std::int32_t> VisiblePoints(const PosedEdges& view, const std::vector<MappedPoint>& points);

}  // namespace evit
