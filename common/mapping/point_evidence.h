#pragma once

#include <Eigen/Core>

#include "common/mapping/edge_adjustment_options.h"
#include "common/mapping/edge_sighting.h"
#include "common/mapping/posed_edges.h"

namespace evit {

/// What the views say of one point: the normal equations of its position and its lag.
class PointEvidence {
 public:
  /// `view` should show the point; where it does, the sighting counts.
  void Add(const EdgeSighting& sighting, const PinholeView& view, double edge_sigma_px);
  void Add(const PointEvidence& other);

  int expected() const { return expected_; }  // views that should show the point
  int seen() const { return seen_; }          // that show it

  /// Turns the point's direction to how the views see its edge slant and gives it its sigma; moves it, and
  /// its lag, if `move`, at most by centimetres. `measured`: as it was first found, which holds it there.
  void Fit(const MappedPoint& measured, bool move, const EdgeAdjustmentOptions& options,
           MappedPoint* point) const;

 private:
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();  // of the position, map frame; m^-2
  Eigen::Vector3d gradient_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_lag_ = Eigen::Vector3d::Zero();  // of position and lag together
  double lag_information_ = 0, lag_gradient_ = 0;     // of the lag; px^-2
  int expected_ = 0, seen_ = 0;
};

}  // namespace evit
