#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/map/view_projector.h"

namespace evit {

/// Map points of one keyframe as the solver wants them: in single precision, relative to a point among them,
/// so that nothing is lost where the map's origin is far away.
class AlignmentPoints {
 public:
  AlignmentPoints() = default;
  /// `points`: map frame, m.
  AlignmentPoints(const std::vector<Eigen::Vector3f>& points)
      : origin_(points.empty() ? Eigen::Vector3f::Zero() : points.front()) {
    local_.Resize(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) local_.Set(k, points[k] - origin_);
  }

  std::size_t size() const { return local_.size(); }
  const PointArrays& local() const { return local_; }
  PointArrays* mutable_local() { return &local_; }
  Eigen::Vector3d origin() const { return origin_.cast<double>(); }
  Eigen::Vector3d At(std::size_t k) const { return local_.At(k).cast<double>() + origin(); }

 private:
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  PointArrays local_;
};

}  // namespace evit
