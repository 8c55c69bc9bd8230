#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/lane_camera.h"
#include "common/map/map_index.h"
#include "common/map/occlusion.h"

namespace evit {

/// Points as three arrays, for loops over lanes: with a block more than there are points, so that a loop may
/// read whole blocks from any place.
class PointArrays {
 public:
  std::size_t size() const { return n_; }
  void Resize(std::size_t n) {
    n_ = n;
    for (std::vector<float>* v : {&x_, &y_, &z_}) v->resize(n + kLanes);
  }
  void Set(std::size_t k, const Eigen::Vector3f& p) { x_[k] = p.x(), y_[k] = p.y(), z_[k] = p.z(); }
  Eigen::Vector3f At(std::size_t k) const { return {x_[k], y_[k], z_[k]}; }
  const float* x() const { return x_.data(); }  // m
  const float* y() const { return y_.data(); }
  const float* z() const { return z_.data(); }
  float* mutable_x() { return x_.data(); }
  float* mutable_y() { return y_.data(); }
  float* mutable_z() { return z_.data(); }

 private:
  std::size_t n_ = 0;
  std::vector<float> x_, y_, z_;
};

/// Projects many points into one view, in single precision (errors below 1e-3 pixels in rooms).
class ViewProjector {
 public:
  /// In view: depth within [min_depth, max_depth], pixel in the image and `margin_px` around it (negative:
  /// only that far inside).
  ViewProjector(const Camera& camera, const SE3& T_camera_map, double margin_px, double min_depth,
                double max_depth);

  /// Those of points [begin, end) that are in view, in their order, to `seen`, which has room for one more
  /// than all of them; returns how many. `ids` gives the points' ids.
  std::size_t Project(const PointArrays& points, const std::int32_t* ids, std::size_t begin, std::size_t end,
                      ProjectedPoint* seen) const;

  struct View {
    LaneCamera camera;
    bool fisheye;
    float R[9], t[3];  // camera from map, row-major
    float left, right, top, bottom, near, far;
  };

 private:
  View view_;
};

}  // namespace evit
