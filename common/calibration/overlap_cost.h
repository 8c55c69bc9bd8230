#pragma once

#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/overlap/map_event_overlap.h"
#include "common/tracking/event_alignment.h"
#include "common/tracking/surface_field.h"

namespace evit {

/// How badly a map lies on the events of many views, over the extrinsics and the time offset of the camera,
/// where the body's poses are known. One blur of the events.
///
/// Each view's pixels that fired become a field: blurred, less their density around (blurred four times as
/// wide), so that what is crowded everywhere attracts nothing. The cost is the tracker's, with the field in
/// place of a time surface (EvaluateAlignment).
class OverlapCost {
 public:
  /// Position (body frame, m), rotation (camera frame, rad), offset (s), lag (pixels).
  using Vector = Eigen::Matrix<double, 8, 1>;
  using Matrix = Eigen::Matrix<double, 8, 8>;

  struct Values {
    SE3 T_body_camera;
    double offset = 0;  // s to add to the camera's stamps to get the IMU's
    double lag_px = 0;  // events come when the edge has moved on by so much
    Values Plus(const Vector& d) const {
      return {T_body_camera.Plus(d.head<6>()), offset + d[6], lag_px + d[7]};
    }
  };
  struct Term {
    double cost = 0;
    Vector gradient = Vector::Zero();
    Matrix hessian = Matrix::Zero();
  };

  /// `views`: events filled in. `blur_px`: Gaussian, of the pixels that fired. Views and poses must outlive
  /// this.
  OverlapCost(const std::vector<MapView>* views, const Trajectory* body, const Camera& camera,
              double blur_px);

  /// Of each view; zero for one that the poses do not cover.
  std::vector<Term> Each(const Values& values) const;
  Term Total(const Values& values) const;
  /// The cost alone, of every `every`-th view.
  double Sparse(const Values& values, std::size_t every) const;
  MapEventOverlap Overlap(const Values& values) const;

 private:
  Term Of(std::size_t view, const Values& values) const;
  bool BodyAt(std::size_t view, const Values& values, Utime shift, SE3* T_map_body) const;

  const std::vector<MapView>* views_;
  const Trajectory* body_;
  AlignmentSettings settings_;  // the camera's frame in place of the body's
  std::vector<SurfaceField> fields_;
  std::vector<AlignmentPoints> points_;
};

}  // namespace evit
