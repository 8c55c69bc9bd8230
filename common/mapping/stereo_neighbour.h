#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/mapping/posed_edges.h"

namespace evit {

/// An edge of the key view, as a ray of its camera.
struct EdgeRay {
  EdgeRay(const PosedEdges& view, const EdgePixel& edge, double typical_depth);

  Eigen::Vector3d ray;      // to the edge, z = 1
  Eigen::Vector3d tangent;  // along the edge, per pixel at z = 1
  int way = 0;              // that it goes, see CameraSweep
};

/// A neighbouring view as the key view sees it: a point at inverse depth w on the key's ray is R ray + w t.
class StereoNeighbour {
 public:
  StereoNeighbour(const PosedEdges& key, const PosedEdges& view);

  /// Chooses the edge that is looked for; it is about at `typical_depth` (m).
  void Aim(const EdgeRay& edge, double typical_depth);

  /// The edge in this view's frame at an inverse depth, times the depth.
  Eigen::Vector3d At(double inverse_depth) const { return far_ + inverse_depth * t_; }
  /// d(pixel)/d(inverse depth), of p = At(...).
  Eigen::Vector2d Move(const Eigen::Vector3d& p) const;

  const PosedEdges& view() const { return *view_; }
  const Eigen::Vector3d& t() const { return t_; }
  const Eigen::Vector2f& normal() const { return normal_; }  // that the edge is expected to have
  int bin() const { return bin_; }                           // of this normal, see EdgeImage
  bool shows() const { return shows_; }                      // this edge, when it is as far away as most
  /// Derivative of the distance to the edge by the lag: where both views see it go the same way, none.
  double late() const { return late_; }

 private:
  const PosedEdges* view_;
  Eigen::Matrix3d R_;
  Eigen::Vector3d t_;
  Eigen::Vector3d far_ = Eigen::Vector3d::Zero();  // R ray
  Eigen::Vector2f normal_ = Eigen::Vector2f::Zero();
  int bin_ = 0;
  bool shows_ = true;
  double late_ = 0;
};

}  // namespace evit
